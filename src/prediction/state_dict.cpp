#include "prediction/state_dict.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "prediction/detail/bytes.hpp"
#include "prediction/detail/pickle.hpp"
#include "prediction/detail/zip.hpp"

namespace clearway::prediction {
namespace {

using detail::PickleDocument;
using detail::PickledTensor;
using detail::PickleValue;
using detail::ZipEntry;

constexpr const char* save_again = "Save it again with torch.save(model.state_dict(), file)";
constexpr std::size_t most_tensors = 1000;
constexpr std::int64_t most_values = 20'000'000;
/// How files of torch before 1.6 start: a pickled magic number instead of an archive.
constexpr std::string_view old_format("\x80\x02\x8a\x0a\x6c\xfc\x9c\x46\xf9\x20", 10);

[[noreturn]] void refuse(const std::string& where, const std::string& what, const std::string& allowed = "",
                         const std::string& cure = save_again) {
    throw core::InputError({where, what, allowed, cure});
}

/// IEEE 754 half precision: 1 sign, 5 exponent (biased by 15), 10 fraction bits.
float float_from_half(std::uint16_t half) {
    const unsigned exponent = (half >> 10) & 0x1fU;
    const unsigned fraction = half & 0x3ffU;
    const float sign = (half & 0x8000U) != 0 ? -1.0F : 1.0F;
    if (exponent == 0x1f) return fraction == 0 ? sign * INFINITY : NAN;
    if (exponent == 0) return sign * std::ldexp(static_cast<float>(fraction), -24);
    return sign * std::ldexp(static_cast<float>(fraction + 0x400U), static_cast<int>(exponent) - 25);
}

/// How the values of a type of storage are read.
struct StorageType {
    std::string_view name;
    std::size_t width = 0;  ///< Bytes of a value.
    float (*value)(std::string_view storage, std::size_t at) = nullptr;
};
constexpr StorageType storage_types[] = {
    {"FloatStorage", 4,
     [](std::string_view from, std::size_t at) { return *detail::number_at<float>(from, at * 4); }},
    {"DoubleStorage", 8,
     [](std::string_view from, std::size_t at) {
         return static_cast<float>(*detail::number_at<double>(from, at * 8));
     }},
    {"HalfStorage", 2,
     [](std::string_view from, std::size_t at) {
         return float_from_half(*detail::number_at<std::uint16_t>(from, at * 2));
     }},
    {"BFloat16Storage", 2,
     [](std::string_view from, std::size_t at) {
         return std::bit_cast<float>(std::uint32_t{*detail::number_at<std::uint16_t>(from, at * 2)} << 16);
     }},
};

/// A file of torch.save, opened.
struct Archive {
    const std::string& source;
    std::vector<ZipEntry> entries;
    std::string folder;  ///< With its slash.

    const ZipEntry* find(const std::string& name) const {
        const auto found = std::ranges::find(entries, folder + name, &ZipEntry::name);
        return found == entries.end() ? nullptr : &*found;
    }
};

Archive opened(std::string_view bytes, const std::string& source) {
    if (bytes.starts_with(old_format))
        refuse(source, "has the format of torch before 1.6", "a zip archive",
               "Save it again with torch.save(model.state_dict(), file), of torch 1.6 or newer");
    Archive archive{source, detail::zip_entries(bytes, source), {}};
    constexpr std::string_view pickle = "data.pkl";
    const auto found = std::ranges::find_if(
        archive.entries, [&](const ZipEntry& entry) { return entry.name.ends_with(pickle); });
    if (found == archive.entries.end()) refuse(source, "holds no data.pkl", "an archive of torch.save");
    archive.folder = found->name.substr(0, found->name.size() - pickle.size());
    if (archive.find("constants.pkl") != nullptr)
        refuse(source, "is a TorchScript program", "a state dict",
               "Save the parameters alone: torch.save(model.state_dict(), file)");
    const ZipEntry* const order = archive.find("byteorder");
    if (order != nullptr && order->content != "little")
        refuse(source, fmt::format("has {}-endian numbers", order->content), "little-endian numbers",
               "Save it on a little-endian machine");
    return archive;
}

/// Values of the tensor, checked to lie within its storage.
std::int64_t checked_count(const PickledTensor& tensor, const std::string& where) {
    std::int64_t count = 1;
    std::int64_t last = tensor.offset;
    bool is_sound = tensor.shape.size() == tensor.strides.size() && !tensor.shape.empty() &&
                    tensor.offset >= 0 && tensor.storage.count <= most_values &&
                    tensor.offset < tensor.storage.count;
    for (std::size_t axis = 0; is_sound && axis < tensor.shape.size(); ++axis) {
        const std::int64_t size = tensor.shape[axis];
        const std::int64_t stride = tensor.strides[axis];
        is_sound = size > 0 && size <= most_values && stride >= 0 && stride <= most_values;
        if (!is_sound) break;
        count *= size;
        last += (size - 1) * stride;
        is_sound = count <= most_values && last < tensor.storage.count;
    }
    if (!is_sound)
        refuse(where,
               fmt::format("has the shape [{}], strides [{}] and offset {} in a storage of {} values",
                           fmt::join(tensor.shape, ", "), fmt::join(tensor.strides, ", "), tensor.offset,
                           tensor.storage.count),
               "values within their storage");
    return count;
}

/// The values in row-major order.
std::vector<float> values_of(const PickledTensor& tensor, const Archive& archive, const std::string& where) {
    const std::int64_t count = checked_count(tensor, where);
    const auto* const type =
        std::ranges::find(storage_types, std::string_view(tensor.storage.type), &StorageType::name);
    if (type == std::end(storage_types))
        refuse(where, fmt::format("holds whole numbers ({})", tensor.storage.type),
               "FloatStorage, DoubleStorage, HalfStorage, BFloat16Storage", "Save the parameters of the net");
    const ZipEntry* const member = archive.find("data/" + tensor.storage.key);
    const auto wanted = static_cast<std::size_t>(tensor.storage.count) * type->width;
    if (member == nullptr) refuse(where, fmt::format("lacks its values, data/{}", tensor.storage.key));
    if (member->content.size() != wanted)
        refuse(where, fmt::format("has {} bytes of values in {}", member->content.size(), member->name),
               fmt::format("{} bytes", wanted));
    std::vector<float> values;
    values.reserve(static_cast<std::size_t>(count));
    std::vector<std::int64_t> index(tensor.shape.size(), 0);
    std::int64_t at = tensor.offset;
    while (true) {
        values.push_back(type->value(member->content, static_cast<std::size_t>(at)));
        std::size_t axis = index.size();
        while (axis-- > 0) {
            at += tensor.strides[axis];
            if (++index[axis] < tensor.shape[axis]) break;
            at -= tensor.strides[axis] * tensor.shape[axis];
            index[axis] = 0;
        }
        if (axis == std::string::npos) return values;
    }
}

void require_finite(const Tensor& tensor, const std::string& where) {
    const auto found = std::ranges::find_if(tensor.values, [](float value) { return !std::isfinite(value); });
    if (found == tensor.values.end()) return;
    refuse(where,
           fmt::format("holds {}, its value {} of {}", *found, found - tensor.values.begin() + 1,
                       tensor.values.size()),
           "finite numbers", "The training diverged: train again with a smaller learning rate");
}

/// The text that names an entry of a dict, for messages the number where it is none.
std::string key_text(const PickleValue& key) {
    if (const auto* const text = std::get_if<std::string>(&key.content)) return *text;
    return "(no text)";
}

}  // namespace

bool is_pth(std::string_view bytes) {
    return detail::starts_as_zip(bytes) || bytes.starts_with(old_format);
}

std::vector<Tensor> parse_pth(std::string_view bytes, const std::string& source) {
    const Archive archive = opened(bytes, source);
    const PickleDocument document = detail::read_pickle(archive.find("data.pkl")->content, source);
    const auto* const dict = std::get_if<PickleValue::Dict>(&document.at(document.top).content);
    if (dict == nullptr) refuse(source, "holds no dict", "a state dict: tensors by name");
    if (dict->items.empty() || dict->items.size() > most_tensors)
        refuse(source, fmt::format("holds {} tensors", dict->items.size()),
               fmt::format("1 to {}", most_tensors));
    std::vector<Tensor> tensors;
    std::size_t values = 0;
    for (const auto& [key, value] : dict->items) {
        const std::string name = key_text(document.at(key));
        const std::string where = fmt::format("{}: {}", source, name);
        const auto* const pickled = std::get_if<PickledTensor>(&document.at(value).content);
        if (pickled == nullptr)
            refuse(where, "is no tensor", "a state dict: tensors by name",
                   "Of a checkpoint, save the state dict alone: torch.save(model.state_dict(), file)");
        Tensor tensor{name, {pickled->shape.begin(), pickled->shape.end()}, {}};
        tensor.values = values_of(*pickled, archive, where);
        require_finite(tensor, where);
        if (core::contains(tensors, name, &Tensor::name)) refuse(where, "stands twice");
        values += tensor.values.size();
        if (values > most_values)
            refuse(source, "has too many values", fmt::format("{} at most", most_values));
        tensors.push_back(std::move(tensor));
    }
    return tensors;
}

std::string format_pth(const std::vector<Tensor>& tensors, const std::string& stem) {
    detail::ZipArchive archive;
    archive.add(stem + "/data.pkl", detail::format_pickle(tensors));
    for (std::size_t storage = 0; storage < tensors.size(); ++storage) {
        const std::vector<float>& values = tensors[storage].values;
        archive.add(fmt::format("{}/data/{}", stem, storage),
                    {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
    }
    archive.add(stem + "/version", "3\n");
    return std::move(archive).finish();
}

void write_pth(const std::filesystem::path& file, const std::vector<Tensor>& tensors) {
    core::write_atomically(file, format_pth(tensors, file.stem().string()));
}

std::vector<Tensor> renamed_parameters(std::vector<Tensor> tensors, std::span<const std::string> names,
                                       const std::string& net, const std::string& source) {
    const auto ending_of = [](const std::string& name) { return name.substr(name.find('.') + 1); };
    std::vector<std::string> unknown, missing, allowed;
    std::vector<Tensor> renamed;
    for (Tensor& tensor : tensors) {
        const auto found = std::ranges::find_if(names, [&](const std::string& name) {
            const std::string ending = ending_of(name);
            return tensor.name == ending || tensor.name.ends_with("." + ending);
        });
        const bool is_new = found != names.end() && !core::contains(renamed, *found, &Tensor::name);
        if (!is_new) {
            unknown.push_back(tensor.name);
            continue;
        }
        tensor.name = *found;
        renamed.push_back(std::move(tensor));
    }
    for (const std::string& name : names) {
        allowed.push_back(ending_of(name));
        if (!core::contains(renamed, name, &Tensor::name)) missing.push_back(allowed.back());
    }
    if (missing.empty() && unknown.empty()) return renamed;
    const auto listed = [](const std::vector<std::string>& all) {
        constexpr std::size_t most_named = 12;
        const std::string more =
            all.size() > most_named ? fmt::format(" and {} more", all.size() - most_named) : "";
        return fmt::format("{}{}", fmt::join(std::span(all).first(std::min(all.size(), most_named)), ", "),
                           more);
    };
    std::string what = fmt::format("is not a state dict of {}: ", net);
    if (!missing.empty()) what += fmt::format("it lacks {}", listed(missing));
    if (!missing.empty() && !unknown.empty()) what += "; ";
    if (!unknown.empty()) what += fmt::format("it also has {}", listed(unknown));
    throw core::InputError({source, what, fmt::format("{}, with any prefix", fmt::join(allowed, ", ")),
                            "Save a net of that class, or choose the predictor that the net is for"});
}

}  // namespace clearway::prediction
