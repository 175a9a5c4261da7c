// Runs the built command as a user would, in a folder of the test's own.
#pragma once
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

namespace loopwright {

struct CommandOutcome {
  int status = -1;  // exit status; 128 + signal if one ended it
  std::string out, err;
};

// A fresh folder that goes with the object.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path file(const std::string& name) const { return path_ / name; }
  std::filesystem::path write(const std::string& name, const std::string& content) const;
  std::vector<std::string> names() const;  // of what lies in it, sorted

 private:
  std::filesystem::path path_;
};

// `interrupt_after_s` > 0: SIGINT is sent after that time. Standard input is empty.
CommandOutcome run_command(const std::vector<std::string>& arguments, const TemporaryFolder& folder,
                           double interrupt_after_s = 0);

std::string file_content(const std::filesystem::path& path);

}  // namespace loopwright
