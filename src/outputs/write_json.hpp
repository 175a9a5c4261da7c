// Results as JSON: an ordered list of keys and values, written as it stands.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace loopwright {

class JsonValue;
using JsonArray = std::vector<JsonValue>;
using JsonObject = std::vector<std::pair<std::string, JsonValue>>;  // keeps its order

// A JSON value. Numbers that are not finite become null, as JSON has no word for them.
class JsonValue {
 public:
  using Variant =
      std::variant<std::nullptr_t, bool, std::int64_t, double, std::string, JsonArray, JsonObject>;

  JsonValue() = default;
  JsonValue(std::nullptr_t) {}
  JsonValue(bool v) : value_(v) {}
  JsonValue(int v) : value_(std::int64_t{v}) {}
  JsonValue(long v) : value_(std::int64_t{v}) {}
  JsonValue(long long v) : value_(std::int64_t{v}) {}
  JsonValue(std::size_t v) : value_(static_cast<std::int64_t>(v)) {}
  JsonValue(double v) : value_(v) {}
  JsonValue(const char* v) : value_(std::string(v)) {}
  JsonValue(std::string_view v) : value_(std::string(v)) {}
  JsonValue(std::string v) : value_(std::move(v)) {}
  JsonValue(JsonArray v) : value_(std::move(v)) {}
  JsonValue(JsonObject v) : value_(std::move(v)) {}
  template <class T>
  JsonValue(const std::vector<T>& list) : value_(JsonArray(list.begin(), list.end())) {}

  const Variant& variant() const { return value_; }

 private:
  Variant value_ = nullptr;
};

// Doubles are printed with the fewest digits that read back to the same bits. Bytes that are not UTF-8 are
// replaced.
std::string json_text(const JsonObject& results);

// Writes json_text() and a newline; the path `-` is standard output. Throws FileError.
void write_json(const std::filesystem::path& path, const JsonObject& results);

}  // namespace loopwright
