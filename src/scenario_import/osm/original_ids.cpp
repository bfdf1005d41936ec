#include "scenario_import/osm/original_ids.hpp"

#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "scenario_import/detail/element.hpp"

namespace clearway::scenario_import::detail {

namespace {

/// The ids of one kind of object before they were numbered from 1, in that order: 8 bytes each, native.
class OldIds {
  public:
    explicit OldIds(const std::filesystem::path& file) {
        if (!std::filesystem::exists(file)) return;  // A map without such objects has no index of them.
        const std::string bytes = core::read_file(file);
        ids_.resize(bytes.size() / sizeof(std::int64_t));
        std::memcpy(ids_.data(), bytes.data(), ids_.size() * sizeof(std::int64_t));
    }

    std::string of(const std::string& number) const {
        std::size_t value = 0;
        std::from_chars(number.data(), number.data() + number.size(), value);
        if (value == 0 || value > ids_.size())
            throw core::InputError(
                core::Problem{"the map", fmt::format("has an object {} that osmium did not number", number),
                              fmt::format("1 to {}", ids_.size()), "download it again"});
        return std::to_string(ids_[value - 1]);
    }

  private:
    std::vector<std::int64_t> ids_;
};

}  // namespace

void restore_ids(const std::filesystem::path& numbered, const std::filesystem::path& index,
                 const std::filesystem::path& restored) {
    std::map<std::string, OldIds> kinds;
    for (const char* const kind : {"node", "way", "relation"})
        kinds.emplace(kind, OldIds(index / fmt::format("{}.idx", kind)));
    const auto restore = [&](Element& element, const char* attribute, const std::string& kind) {
        const auto ids = kinds.find(kind);
        if (ids != kinds.end()) element.set(attribute, ids->second.of(element.text(attribute)));
    };
    std::ofstream stream(restored);
    stream << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<osm version=\"0.6\">\n";
    for_each_element(numbered, [&](Element&& element) {
        restore(element, "id", element.name);
        for (Element& child : element.children) {
            if (child.name == "nd") restore(child, "ref", "node");
            if (child.name == "member") restore(child, "ref", child.text("type"));
        }
        stream << element.xml();
    });
    stream << "</osm>\n";
    stream.close();
    if (!stream) throw core::write_error(restored, errno);
}

}  // namespace clearway::scenario_import::detail
