#include "trace/detail/hdf5.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cerrno>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "trace/detail/seal.hpp"

namespace clearway::trace::detail {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

/// Elements per chunk, and the most bytes a chunk may have. One chunk of each data set is in memory.
constexpr std::size_t chunk_elements = 16384;
constexpr std::size_t chunk_bytes = std::size_t{1} << 20U;
/// docs/decisions/0005-recordings-in-hdf5.md compares other levels.
constexpr unsigned deflate_level = 4;

/// Call it before the first use of HDF5 in each thread. HDF5 then prints no errors, because they are thrown,
/// and does not try to close files at exit, which fails on a full disk.
void prepare_library() {
    static const bool once = [] {
        H5dont_atexit();
        return H5open() >= 0;
    }();
    if (!once) throw Hdf5Error("HDF5 cannot be initialised", ENOMEM);  // there it only allocates
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

struct Failure {
    std::string message = "HDF5 failed";
    int reason = 0;
    bool lacks_memory = false;
};

herr_t take_failure(unsigned depth, const H5E_error2_t* error, void* target) {
    auto& failure = *static_cast<Failure*>(target);
    const std::string_view words = error->desc == nullptr ? "" : error->desc;
    if (depth == 0) failure.message = words;
    const std::size_t at = words.find("errno = ");
    if (at != std::string_view::npos) failure.reason = std::atoi(words.data() + at + 8);
    // inflate() gets bytes whose checksum was right: what it can lack is memory for its window. Lists of
    // properties are in no file.
    if (error->maj_num == H5E_RESOURCE || error->min_num == H5E_CANTALLOC || words.starts_with("inflate") ||
        words.find("property list") != std::string_view::npos)
        failure.lacks_memory = true;
    return 0;
}

[[noreturn]] void fail() {
    Failure failure;
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_failure, &failure);
    throw Hdf5Error(failure.message, failure.reason == 0 && failure.lacks_memory ? ENOMEM : failure.reason);
}

Handle property_list(hid_t list_class) {
    return {H5Pcreate(list_class), H5Pclose};
}

/// Each chunk is written or read whole and once, so a cache would waste memory.
Handle without_cache() {
    Handle access = property_list(H5P_DATASET_ACCESS);
    check(H5Pset_chunk_cache(access.get(), 0, 0, 1.0));
    return access;
}

Handle filtered(std::size_t chunk) {
    Handle creation = property_list(H5P_DATASET_CREATE);
    const hsize_t length = chunk;
    check(H5Pset_chunk(creation.get(), 1, &length));
    check(H5Pset_shuffle(creation.get()));
    check(H5Pset_deflate(creation.get(), deflate_level));
    check(H5Pset_fletcher32(creation.get()));
    check(H5Pset_obj_track_times(creation.get(), false));
    return creation;
}

void write_attribute(hid_t object, const std::string& name, hid_t type, const void* value) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate2(object, name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    check(H5Awrite(attribute.get(), type, value));
}

template <class Number>
Number read_number(hid_t attribute, hid_t type) {
    Number number{};
    check(H5Aread(attribute, type, &number));
    return number;
}

/// Texts have a fixed length: HDF5 1.10 follows the references of others beyond what a damaged file holds.
std::string read_text(hid_t attribute, hid_t type) {
    const std::size_t length = H5Tget_size(type);
    if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 || length > most_text_bytes)
        throw std::runtime_error("an attribute is no text of fixed length");
    std::string text(length, '\0');
    check(H5Aread(attribute, text_type(length).get(), text.data()));
    return text.substr(0, text.find('\0'));
}

core::Json read_attribute(hid_t attribute) {
    const Handle space(H5Aget_space(attribute), H5Sclose);
    if (H5Sget_simple_extent_npoints(space.get()) != 1)
        throw std::runtime_error("an attribute is no single value");
    const Handle type(H5Aget_type(attribute), H5Tclose);
    switch (H5Tget_class(type.get())) {
        case H5T_INTEGER:
            if (H5Tget_sign(type.get()) == H5T_SGN_NONE)
                return read_number<std::uint64_t>(attribute, H5T_NATIVE_UINT64);
            return read_number<std::int64_t>(attribute, H5T_NATIVE_INT64);
        case H5T_FLOAT:
            return read_number<double>(attribute, H5T_NATIVE_DOUBLE);
        default:
            return read_text(attribute, type.get());
    }
}

}  // namespace

Handle::Handle(hid_t id, Close closing) : id_(id), close_(closing) {
    if (id < 0) fail();
}
Handle::Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
Handle& Handle::operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
}
Handle::~Handle() {
    if (id_ >= 0) close_(id_);
}
void Handle::close() {
    if (id_ >= 0) check(close_(std::exchange(id_, -1)));
}

void check(herr_t code) {
    if (code < 0) fail();
}

Handle create_file(const std::filesystem::path& file) {
    prepare_library();
    const Handle creation = property_list(H5P_FILE_CREATE);
    check(H5Pset_userblock(creation.get(), seal_length));
    check(H5Pset_obj_track_times(creation.get(), false));
    const Handle access = property_list(H5P_FILE_ACCESS);
    check(H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110));
    check(H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG));
    check(H5Pset_file_locking(access.get(), false, true));
    return {H5Fcreate(file.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose};
}

Handle open_file(const std::filesystem::path& file) {
    prepare_library();
    const Handle access = property_list(H5P_FILE_ACCESS);
    check(H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG));
    check(H5Pset_file_locking(access.get(), false, true));
    return {H5Fopen(file.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose};
}

Handle create_group(hid_t parent, const std::string& name) {
    const Handle links = property_list(H5P_LINK_CREATE);
    check(H5Pset_create_intermediate_group(links.get(), 1));
    const Handle creation = property_list(H5P_GROUP_CREATE);
    check(H5Pset_obj_track_times(creation.get(), false));
    return {H5Gcreate2(parent, name.c_str(), links.get(), creation.get(), H5P_DEFAULT), H5Gclose};
}

void write_attribute(hid_t object, const std::string& name, const std::string& text) {
    const std::string letters = text.empty() ? std::string(1, '\0') : text;  // HDF5 has no text of no bytes
    write_attribute(object, name, text_type(letters.size()).get(), letters.data());
}

void write_attributes(hid_t object, const core::Json& members) {
    for (const auto& [name, value] : members.items()) {
        if (value.is_number_float()) {
            const auto number = value.get<double>();
            write_attribute(object, name, H5T_IEEE_F64LE, &number);
        } else if (value.is_number_unsigned()) {
            const auto number = value.get<std::uint64_t>();
            write_attribute(object, name, H5T_STD_U64LE, &number);
        } else if (value.is_number()) {
            const auto number = value.get<std::int64_t>();
            write_attribute(object, name, H5T_STD_I64LE, &number);
        } else {
            write_attribute(object, name,
                            value.is_string() ? value.get<std::string>() : core::to_text(value));
        }
    }
}

core::Json read_attributes(hid_t object) {
    core::Json members = core::Json::object();
    H5O_info_t info{};
    check(H5Oget_info2(object, &info, H5O_INFO_NUM_ATTRS));
    for (hsize_t i = 0; i < info.num_attrs; ++i) {
        const Handle attribute(
            H5Aopen_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, i, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
        std::string name(256, '\0');
        const ssize_t length = H5Aget_name(attribute.get(), name.size(), name.data());
        check(length < 0 ? -1 : 0);
        name.resize(std::min(name.size() - 1, static_cast<std::size_t>(length)));
        members[name] = read_attribute(attribute.get());
    }
    return members;
}

Handle named_type(std::span<const std::string_view> names) {
    assert(!names.empty() && names.size() <= 256);  // numbered by one byte
    Handle type(H5Tenum_create(H5T_STD_U8LE), H5Tclose);
    std::uint8_t number = 0;
    for (const std::string_view name : names) {
        check(H5Tenum_insert(type.get(), std::string(name).c_str(), &number));
        ++number;
    }
    return type;
}

Handle text_type(std::size_t length) {
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    assert(length > 0);  // HDF5 has no text of no bytes
    check(H5Tset_size(type.get(), length));
    check(H5Tset_strpad(type.get(), H5T_STR_NULLPAD));
    check(H5Tset_cset(type.get(), H5T_CSET_UTF8));
    return type;
}

DataSet::DataSet(hid_t group, const Column& column, hid_t type)
    : type_(type),
      width_(H5Tget_size(type)),
      chunk_(std::clamp<std::size_t>(chunk_bytes / width_, 1, chunk_elements)) {
    const hsize_t empty = 0;
    const hsize_t unlimited = H5S_UNLIMITED;
    const Handle space(H5Screate_simple(1, &empty, &unlimited), H5Sclose);
    set_ = Handle(H5Dcreate2(group, column.name.c_str(), type, space.get(), H5P_DEFAULT,
                             filtered(chunk_).get(), without_cache().get()),
                  H5Dclose);
    if (*column.unit != '\0') write_attribute(set_.get(), "unit", column.unit);
    if (*column.doc != '\0') write_attribute(set_.get(), "doc", column.doc);
}

DataSet::DataSet(hid_t group, const std::string& name, hid_t type)
    : set_(H5Dopen2(group, name.c_str(), without_cache().get()), H5Dclose),
      type_(type),
      width_(H5Tget_size(type)),
      chunk_(std::clamp<std::size_t>(chunk_bytes / width_, 1, chunk_elements)) {
    const Handle found(H5Dget_type(set_.get()), H5Tclose);
    const htri_t is_equal = H5Tequal(found.get(), type);
    check(is_equal < 0 ? -1 : 0);
    if (is_equal == 0) throw std::runtime_error(name + " is of another type");
    const Handle space(H5Dget_space(set_.get()), H5Sclose);
    if (H5Sget_simple_extent_ndims(space.get()) != 1) throw std::runtime_error(name + " is no column");
    const hssize_t size = H5Sget_simple_extent_npoints(space.get());
    check(size < 0 ? -1 : 0);
    size_ = static_cast<std::size_t>(size);
}

Handle DataSet::select(std::size_t first, std::size_t count) const {
    assert(count > 0);
    Handle space(H5Dget_space(set_.get()), H5Sclose);
    const hsize_t start = first;
    const hsize_t length = count;
    check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, &start, nullptr, &length, nullptr));
    return space;
}

void DataSet::append(const void* elements, std::size_t count) {
    if (count == 0) return;
    const hsize_t length = count;
    const hsize_t end = size_ + count;
    check(H5Dset_extent(set_.get(), &end));
    const Handle memory(H5Screate_simple(1, &length, nullptr), H5Sclose);
    check(H5Dwrite(set_.get(), type_, memory.get(), select(size_, count).get(), H5P_DEFAULT, elements));
    hash_.add({static_cast<const char*>(elements), count * width_});
    size_ += count;
}

void DataSet::read(std::size_t first, std::size_t count, void* elements) {
    if (count == 0) return;
    const hsize_t length = count;
    const Handle memory(H5Screate_simple(1, &length, nullptr), H5Sclose);
    assert(first + count <= size_);
    check(H5Dread(set_.get(), type_, memory.get(), select(first, count).get(), H5P_DEFAULT, elements));
    hash_.add({static_cast<const char*>(elements), count * width_});
}

}  // namespace clearway::trace::detail
