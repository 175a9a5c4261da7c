// loopwright view: hands over to the desktop application, a program of its own that lies beside this one.
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "commands.hpp"

namespace loopwright {

int run(const ViewCommand& command) {
  std::error_code fault;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", fault);
  const std::filesystem::path program = self.parent_path() / "loopwright-view";
  if (fault || !std::filesystem::exists(program))
    throw std::runtime_error(
        "the desktop application is not built: install qt6-base-dev and libqt6opengl6-dev, then build "
        "loopwright again (or install the package that holds loopwright-view)");
  std::string name = program.string(), file = command.file;
  std::vector<char*> words{name.data()};
  if (!file.empty()) words.push_back(file.data());
  words.push_back(nullptr);
  execv(name.c_str(), words.data());
  throw std::runtime_error(name + " cannot be started: " + std::strerror(errno));
}

}  // namespace loopwright
