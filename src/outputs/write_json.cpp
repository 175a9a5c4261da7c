#include "outputs/write_json.hpp"

#include <iostream>
#include <nlohmann/json.hpp>

#include "outputs/atomic_file.hpp"

namespace loopwright {
namespace {

using Json = nlohmann::ordered_json;

struct ToJson {
  Json operator()(const JsonArray& list) const {
    Json out = Json::array();
    for (const JsonValue& v : list) out.push_back(std::visit(*this, v.variant()));
    return out;
  }
  Json operator()(const JsonObject& object) const {
    Json out = Json::object();
    for (const auto& [key, v] : object) out[key] = std::visit(*this, v.variant());
    return out;
  }
  template <class T>
  Json operator()(const T& plain) const {
    return plain;  // nlohmann writes numbers that are not finite as null
  }
};

}  // namespace

std::string json_text(const JsonObject& results) {
  return ToJson{}(results).dump(2, ' ', false, Json::error_handler_t::replace);
}

void write_json(const std::filesystem::path& path, const JsonObject& results) {
  const std::string text = json_text(results) + '\n';
  if (path == "-") {
    std::cout << text << std::flush;
    if (!std::cout) throw FileError("cannot write the results to standard output");
    return;
  }
  AtomicFile file(path);
  file.stream() << text;
  file.commit();
}

}  // namespace loopwright
