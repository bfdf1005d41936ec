#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include <hdf5.h>

#include "core/json.hpp"
#include "core/running_hash.hpp"

namespace clearway::trace::detail {

/// An HDF5 identifier and the function that closes it.
class Handle {
  public:
    using Close = herr_t (*)(hid_t);
    Handle() = default;
    /// Throws std::runtime_error with HDF5's message when `id` is invalid.
    Handle(hid_t id, Close closing);
    Handle(Handle&& other) noexcept;
    Handle& operator=(Handle&& other) noexcept;
    ~Handle();
    hid_t get() const { return id_; }
    /// Closes it now. Throws as the constructor does.
    void close();

  private:
    hid_t id_ = -1;
    Close close_ = nullptr;
};

/// HDF5 failed. `reason` is the system's errno, ENOMEM when HDF5 got no memory, 0 when it gives none.
class Hdf5Error : public std::runtime_error {
  public:
    Hdf5Error(const std::string& message, int reason) : std::runtime_error(message), reason_(reason) {}
    int reason() const { return reason_; }

  private:
    int reason_;
};

/// Throws Hdf5Error for a negative `code`.
void check(herr_t code);

/// Creates an empty HDF5 file with a user block for the seal, replacing `file`. Its bytes depend only on what
/// is written into it.
Handle create_file(const std::filesystem::path& file);
Handle open_file(const std::filesystem::path& file);
Handle create_group(hid_t parent, const std::string& name);

/// Text as variable-length UTF-8.
void write_attribute(hid_t object, const std::string& name, const std::string& text);
/// One attribute per member: numbers and text as such, everything else as JSON.
void write_attributes(hid_t object, const core::Json& members);
/// All attributes, numbers and text.
core::Json read_attributes(hid_t object);

/// Element types of data sets, little endian.
template <class Number>
hid_t number_type();
template <>
inline hid_t number_type<std::uint8_t>() {
    return H5T_STD_U8LE;
}
template <>
inline hid_t number_type<std::uint32_t>() {
    return H5T_STD_U32LE;
}
template <>
inline hid_t number_type<std::uint64_t>() {
    return H5T_STD_U64LE;
}
template <>
inline hid_t number_type<std::int32_t>() {
    return H5T_STD_I32LE;
}
template <>
inline hid_t number_type<std::int64_t>() {
    return H5T_STD_I64LE;
}
template <>
inline hid_t number_type<float>() {
    return H5T_IEEE_F32LE;
}
template <>
inline hid_t number_type<double>() {
    return H5T_IEEE_F64LE;
}
/// An enumeration of one byte with these names, numbered from 0.
Handle named_type(std::span<const std::string_view> names);
/// Longest text that is read; a damaged file can name any length.
inline constexpr std::size_t most_text_bytes = std::size_t{1} << 26;
/// Text of `length` bytes, padded with zeros.
Handle text_type(std::size_t length);

/// Name, unit and description of a data set.
struct Column {
    std::string name;
    const char* unit = "";
    const char* doc = "";
};

/// A one-dimensional data set that grows by whole chunks: shuffled, deflated and with checksums. Bytes are
/// copied to and from memory unchanged.
class DataSet {
  public:
    /// Creates it.
    DataSet(hid_t group, const Column& column, hid_t type);
    /// Opens it. Throws std::runtime_error when it is missing or has another type.
    DataSet(hid_t group, const std::string& name, hid_t type);

    std::size_t size() const { return size_; }
    /// Elements per chunk.
    std::size_t chunk() const { return chunk_; }
    void append(const void* elements, std::size_t count);
    /// Reads from `first` on.
    void read(std::size_t first, std::size_t count, void* elements);
    /// Hash of all elements appended or read so far, in order.
    std::string digest() const { return hash_.digest(); }

  private:
    Handle select(std::size_t first, std::size_t count) const;

    Handle set_;
    hid_t type_;
    std::size_t width_;
    std::size_t chunk_ = 0;
    std::size_t size_ = 0;
    core::RunningHash hash_;
};

}  // namespace clearway::trace::detail
