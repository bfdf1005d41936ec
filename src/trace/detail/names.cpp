#include <algorithm>
#include <stdexcept>

#include "trace/detail/tables.hpp"

namespace clearway::trace::detail {
namespace {

constexpr const char* vehicles_path = "vehicles";
constexpr const char* texts_path = "texts";
/// Of all rows together.
constexpr std::size_t most_texts_bytes = std::size_t{1} << 32;

/// Text as a data set of rows of equal length: unlike rows of variable length, these are compressed.
void write_texts(hid_t group, const Column& column, const std::vector<std::string>& texts) {
    std::size_t longest = 1;
    for (const std::string& text : texts) {
        if (text.find('\0') != std::string::npos)
            throw std::invalid_argument("a text to be recorded contains a zero byte: " + text);
        longest = std::max(longest, text.size());
    }
    const Handle type = text_type(longest);
    DataSet set(group, column, type.get());
    std::string rows;
    std::size_t count = 0;
    for (const std::string& text : texts) {
        rows += text;
        rows.append(longest - text.size(), '\0');
        if (++count < set.chunk()) continue;
        set.append(rows.data(), count);
        rows.clear();
        count = 0;
    }
    set.append(rows.data(), count);
}

std::vector<std::string> read_texts(hid_t group, const std::string& name) {
    const Handle found(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose);
    const Handle type(H5Dget_type(found.get()), H5Tclose);
    if (H5Tget_class(type.get()) != H5T_STRING) throw std::runtime_error(name + " is not text");
    const std::size_t longest = H5Tget_size(type.get());
    if (longest > most_text_bytes) throw std::runtime_error(name + " is too long");
    const Handle same_type = text_type(longest);
    DataSet set(group, name, same_type.get());
    if (set.size() > most_texts_bytes / longest) throw std::runtime_error(name + " has too many rows");
    std::vector<std::string> texts;
    std::string rows;
    for (std::size_t first = 0; first < set.size(); first += set.chunk()) {
        const std::size_t count = std::min(set.chunk(), set.size() - first);
        rows.assign(count * longest, '\0');
        set.read(first, count, rows.data());
        for (std::size_t row = 0; row < count; ++row) {
            const char* const text = rows.data() + row * longest;
            texts.emplace_back(text, std::find(text, text + longest, '\0'));
        }
    }
    return texts;
}

}  // namespace

void Names::write(TableWriter& file) const {
    const Handle vehicles = create_group(file.id(), vehicles_path);
    write_attribute(vehicles.get(), "doc", "Every vehicle that the other tables name by its row here");
    DataSet keys(vehicles.get(), {"key", "", "Hash of the id, by which Clearway orders"},
                 number_type<std::uint64_t>());
    std::vector<std::uint64_t> numbers;
    for (const core::VehicleKey key : keys_.values())
        numbers.push_back(key.value);
    for (std::size_t first = 0; first < numbers.size(); first += keys.chunk())
        keys.append(numbers.data() + first, std::min(keys.chunk(), numbers.size() - first));
    write_texts(vehicles.get(), {"id", "", "SUMO's id; empty for a vehicle that no roster knows"}, ids_);
    const Handle texts = create_group(file.id(), texts_path);
    write_attribute(texts.get(), "doc", "Every text that the other tables name by its row here");
    write_texts(texts.get(), {"value", "", ""}, texts_.values());
}

void Names::read(TableReader& file) {
    const Handle vehicles(H5Gopen2(file.id(), vehicles_path, H5P_DEFAULT), H5Gclose);
    DataSet set(vehicles.get(), "key", number_type<std::uint64_t>());
    std::vector<std::uint64_t> numbers(set.size());
    for (std::size_t first = 0; first < numbers.size(); first += set.chunk())
        set.read(first, std::min(set.chunk(), numbers.size() - first), numbers.data() + first);
    std::vector<core::VehicleKey> keys;
    for (const std::uint64_t number : numbers)
        keys.push_back({number});
    keys_.assign(std::move(keys));
    ids_ = read_texts(vehicles.get(), "id");
    if (ids_.size() != numbers.size()) throw std::runtime_error("vehicles have more or fewer ids than keys");
    const Handle texts(H5Gopen2(file.id(), texts_path, H5P_DEFAULT), H5Gclose);
    texts_.assign(read_texts(texts.get(), "value"));
}

void Names::add_to(core::RunningHash& hash) const {
    for (const core::VehicleKey key : keys_.values())
        hash.add({reinterpret_cast<const char*>(&key.value), sizeof(key.value)});
    for (const std::vector<std::string>* const texts : {&ids_, &texts_.values()}) {
        for (const std::string& text : *texts)
            hash.add(text + '\n');
    }
}

}  // namespace clearway::trace::detail
