// docs/knitout.md names a test for every rule: each of them is there.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace loopwright {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

// What stands between backticks and looks like `Suite.name` or `Suite/case`.
std::set<std::string> tests_named(const std::string& page) {
  std::set<std::string> names;
  for (std::size_t begin = page.find('`'); begin != std::string::npos;) {
    const std::size_t end = page.find('`', begin + 1);
    if (end == std::string::npos) break;
    const std::string word = page.substr(begin + 1, end - begin - 1);
    const std::size_t dot = word.find_first_of("./");
    const bool is_name =
        word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./") ==
        std::string::npos;
    if (is_name && dot != std::string::npos && dot > 0 && word[0] >= 'A' && word[0] <= 'Z')
      names.insert(word);
    begin = page.find('`', end + 1);
  }
  return names;
}

TEST(KnitoutPage, every_test_that_it_names_is_there) {
  const std::filesystem::path root = LOOPWRIGHT_SOURCE_DIR;
  std::string sources;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "tests"))
    if (entry.path().extension() == ".cpp") sources += text_of(entry.path());
  const std::set<std::string> names = tests_named(text_of(root / "docs" / "knitout.md"));
  EXPECT_GT(names.size(), 60u);
  for (const std::string& name : names) {
    const std::size_t dot = name.find_first_of("./");
    const std::string suite = name.substr(0, dot), own = name.substr(dot + 1);
    const bool is_case = name[dot] == '/';
    const bool found = is_case ? sources.find("TEST_P(" + suite + ",") != std::string::npos &&
                                     sources.find("{\"" + own + "\"") != std::string::npos
                               : sources.find("TEST(" + suite + ", " + own + ")") != std::string::npos ||
                                     sources.find("TEST_F(" + suite + ", " + own + ")") != std::string::npos;
    EXPECT_TRUE(found) << name;
  }
}

}  // namespace
}  // namespace loopwright
