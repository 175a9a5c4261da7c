// What is typed and not saved is kept beside the user's settings, so that a crash or a power cut loses
// seconds.
#pragma once
#include <QString>
#include <optional>

#include "document.hpp"

namespace loopwright {

class Autosave {
 public:
  // `folder` is made if it is not there. A file of its own for each running program.
  explicit Autosave(const QString& folder);
  ~Autosave();
  Autosave(const Autosave&) = delete;
  Autosave& operator=(const Autosave&) = delete;

  void keep(const Document& document);  // nothing is kept of a saved document
  void forget();                        // on a clean end

  // The newest text that a program which is gone has left; its file is removed by discard().
  struct Left {
    QString file;
    std::string text;
    std::filesystem::path path;  // of the document
  };
  std::optional<Left> left_behind() const;
  static void discard(const Left& left);

 private:
  QString folder_, file_;
};

}  // namespace loopwright
