#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/ids.hpp"
#include "trace/detail/hdf5.hpp"

namespace clearway::trace::detail {

// Tables of an HDF5 file, one data set per column, written or read row by row. One description serves both
// directions: `File` is a TableWriter and the structs are const, or a TableReader that fills them.

/// Stands for no row.
inline constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// Type of a column's elements in the file.
template <class Value>
struct Stored {
    using Type = Value;
};
template <class Value>
requires std::is_enum_v<Value>
struct Stored<Value> {
    using Type = std::uint8_t;
};
template <>
struct Stored<bool> {
    using Type = std::uint8_t;
};

/// The two names that Python's h5py reads as a `bool`.
inline constexpr std::array<std::string_view, 2> truth_names = {"FALSE", "TRUE"};

template <class Value>
Handle column_type(std::span<const std::string_view> names) {
    if constexpr (std::is_same_v<Value, bool>)
        return named_type(truth_names);
    else if constexpr (std::is_enum_v<Value>)
        return named_type(names);
    else
        return {H5Tcopy(number_type<Value>()), H5Tclose};
}

/// The part of a column that does not depend on its type.
class ColumnFile {
  public:
    ColumnFile(Handle type, std::string path) : type_(std::move(type)), path_(std::move(path)) {}
    ColumnFile(const ColumnFile&) = delete;
    ColumnFile& operator=(const ColumnFile&) = delete;
    virtual ~ColumnFile() = default;
    /// Writes what is still buffered; when reading, throws std::runtime_error if anything is left to be read.
    virtual void finish() = 0;
    const std::string& path() const { return path_; }
    virtual std::string digest() const = 0;

  protected:
    hid_t type() const { return type_.get(); }

  private:
    Handle type_;
    std::string path_;
};

class TableWriter;
class TableReader;

/// A column that is written value by value.
template <class Value>
class OutputColumn : public ColumnFile {
  public:
    template <class File>
    OutputColumn(File& file, hid_t group, const std::string& path, const Column& column,
                 std::span<const std::string_view> names = {})
        : ColumnFile(column_type<Value>(names), path + "/" + column.name), set_(group, column, type()) {
        file.add(*this);
        buffer_.reserve(set_.chunk());
    }
    void operator()(const Value& value) {
        buffer_.push_back(static_cast<Plain>(value));
        if (buffer_.size() == set_.chunk()) write();
    }
    void finish() override { write(); }
    std::string digest() const override { return set_.digest(); }

  private:
    using Plain = typename Stored<Value>::Type;
    void write() {
        set_.append(buffer_.data(), buffer_.size());
        buffer_.clear();
    }
    DataSet set_;
    std::vector<Plain> buffer_;
};

/// A column that is read value by value.
template <class Value>
class InputColumn : public ColumnFile {
  public:
    template <class File>
    InputColumn(File& file, hid_t group, const std::string& path, const Column& column,
                std::span<const std::string_view> names = {})
        : ColumnFile(column_type<Value>(names), path + "/" + column.name),
          set_(group, column.name, type()),
          allowed_(std::is_same_v<Value, bool> ? truth_names.size() : names.size()) {
        file.add(*this);
    }
    void operator()(Value& value) {
        if (at_ == buffer_.size()) read();
        const Plain plain = buffer_[at_++];
        if constexpr (!std::is_same_v<Plain, Value>) {
            if (plain >= allowed_) throw std::runtime_error(path() + " has a value without a name");
        }
        value = static_cast<Value>(plain);
    }
    std::size_t size() const { return set_.size(); }
    void finish() override {
        if (at_ != buffer_.size() || next_ != set_.size())
            throw std::runtime_error(path() + " is longer than its rows");
    }
    std::string digest() const override { return set_.digest(); }

  private:
    using Plain = typename Stored<Value>::Type;
    void read() {
        const std::size_t count = std::min(set_.chunk(), set_.size() - next_);
        if (count == 0) throw std::runtime_error(path() + " is shorter than its rows");
        buffer_.resize(count);
        set_.read(next_, count, buffer_.data());
        next_ += count;
        at_ = 0;
    }
    DataSet set_;
    std::size_t allowed_;
    std::vector<Plain> buffer_;
    std::size_t at_ = 0;
    std::size_t next_ = 0;
};

/// A group of columns of equal length, and the rows of the present step.
class Rows {
  public:
    Rows(Handle group, std::string path) : group_(std::move(group)), path_(std::move(path)) {}
    hid_t group() const { return group_.get(); }
    const std::string& path() const { return path_; }
    /// First row of the present step.
    std::uint64_t begin() const { return begin_; }

  protected:
    Handle group_;
    std::string path_;
    std::uint64_t begin_ = 0;
};

/// The column of `/steps` that says where the rows of each step begin.
inline Column begin_column(const std::string& path) {
    std::string name = path;
    for (char& letter : name)
        if (letter == '/') letter = '_';
    return {name + "_begin", "1", "First row of the step; the next entry ends it"};
}

/// Writes an HDF5 file of tables.
class TableWriter {
  public:
    static constexpr bool reading = false;
    template <class Value>
    using Column = OutputColumn<Value>;

    class Rows : public detail::Rows {
      public:
        Rows(TableWriter& file, const std::string& path, const char* doc)
            : detail::Rows(create_group(file.id(), path), path),
              file_(file),
              offsets_(file, file.steps(), "steps", begin_column(path)) {
            write_attribute(group(), "doc", doc);
            offsets_(begin_);
            file.tables_.push_back(this);
        }
        TableWriter& file() const { return file_; }
        /// Adds `count` rows to the step.
        void count(std::size_t& count) { end_ += count; }
        void end_step() {
            begin_ = end_;
            offsets_(begin_);
        }

      private:
        TableWriter& file_;
        OutputColumn<std::uint64_t> offsets_;
        std::uint64_t end_ = 0;
    };

    explicit TableWriter(const std::filesystem::path& file)
        : file_(create_file(file)), steps_(create_group(file_.get(), "steps")) {}

    hid_t id() const { return file_.get(); }
    /// The group of columns with one row per step.
    hid_t steps() const { return steps_.get(); }
    void add(ColumnFile& column) { columns_.push_back(&column); }
    void end_step() {
        for (Rows* const table : tables_)
            table->end_step();
    }
    /// Writes what the columns still buffer.
    void finish() {
        for (ColumnFile* const column : columns_)
            column->finish();
    }
    const std::vector<ColumnFile*>& columns() const { return columns_; }
    void close() { file_.close(); }

  private:
    Handle file_, steps_;
    std::vector<ColumnFile*> columns_;
    std::vector<Rows*> tables_;
};

/// Reads an HDF5 file of tables.
class TableReader {
  public:
    static constexpr bool reading = true;
    template <class Value>
    using Column = InputColumn<Value>;

    class Rows : public detail::Rows {
      public:
        Rows(TableReader& file, const std::string& path, const char* /*doc*/)
            : detail::Rows(Handle(H5Gopen2(file.id(), path.c_str(), H5P_DEFAULT), H5Gclose), path),
              file_(file),
              offsets_(file, file.steps(), "steps", begin_column(path)) {
            offsets_(end_);
            file.tables_.push_back(this);
        }
        TableReader& file() const { return file_; }
        /// Sets `count` to the number of rows of the step.
        void count(std::size_t& count) const { count = static_cast<std::size_t>(end_ - begin_); }
        void start_step() {
            begin_ = end_;
            offsets_(end_);
            if (end_ < begin_ || end_ - begin_ > most_rows)
                throw std::runtime_error(path_ + " has row numbers that are out of order");
        }

      private:
        /// No step of a run has more; a larger number means damage.
        static constexpr std::uint64_t most_rows = 100'000'000;

        TableReader& file_;
        InputColumn<std::uint64_t> offsets_;
        std::uint64_t end_ = 0;
    };

    explicit TableReader(const std::filesystem::path& file)
        : file_(open_file(file)), steps_(H5Gopen2(file_.get(), "steps", H5P_DEFAULT), H5Gclose) {}

    hid_t id() const { return file_.get(); }
    /// The group of columns with one row per step.
    hid_t steps() const { return steps_.get(); }
    void add(ColumnFile& column) { columns_.push_back(&column); }
    void start_step() {
        for (Rows* const table : tables_)
            table->start_step();
    }
    /// Throws std::runtime_error when a column is longer than its rows.
    void finish() {
        for (ColumnFile* const column : columns_)
            column->finish();
    }
    const std::vector<ColumnFile*>& columns() const { return columns_; }

  private:
    Handle file_, steps_;
    std::vector<ColumnFile*> columns_;
    std::vector<Rows*> tables_;
};

/// A column of `rows`.
template <class File, class Value>
struct ColumnOf : File::template Column<Value> {
    ColumnOf(typename File::Rows& rows, const Column& column, std::span<const std::string_view> names = {})
        : File::template Column<Value>(rows.file(), rows.group(), rows.path(), column, names) {}
};

/// One row per element. `code(element)` writes or fills one of them.
template <class File, class List, class Code>
void list(typename File::Rows& rows, List& elements, const Code& code) {
    std::size_t count = elements.size();
    rows.count(count);
    if constexpr (File::reading) elements.resize(count);
    for (auto& element : elements)
        code(element);
}

/// A column of a wrapped number: an index, a time.
template <class Column, class Quantity>
void code_value(Column& column, Quantity& quantity) {
    column(quantity.value);
}

/// Texts or keys that columns refer to by their row in a table of the whole file.
template <class Value, class Hash = std::hash<Value>>
class Interned {
  public:
    std::uint32_t row_of(const Value& value) {
        const auto [at, is_new] = rows_.try_emplace(value, static_cast<std::uint32_t>(values_.size()));
        if (is_new) values_.push_back(value);
        return at->second;
    }
    const Value& value(std::uint32_t row) const {
        if (row >= values_.size()) throw std::runtime_error("a row is named that does not exist");
        return values_[row];
    }
    void assign(std::vector<Value> values) { values_ = std::move(values); }
    const std::vector<Value>& values() const { return values_; }

  private:
    std::vector<Value> values_;
    std::unordered_map<Value, std::uint32_t, Hash> rows_;
};

/// `/vehicles`, every vehicle that a file names, with its id where a roster knows it; and `/texts`.
class Names {
  public:
    /// Writes a vehicle as its row and returns that; `none` stands for key 0.
    std::uint32_t code(OutputColumn<std::uint32_t>& column, core::VehicleKey key) {
        const std::uint32_t row = key.value == 0 ? none : vehicle(key);
        column(row);
        return row;
    }
    std::uint32_t code(InputColumn<std::uint32_t>& column, core::VehicleKey& key) const {
        std::uint32_t row = none;
        column(row);
        key = row == none ? core::VehicleKey{} : keys_.value(row);
        return row;
    }
    void code_text(OutputColumn<std::uint32_t>& column, std::string_view text) {
        column(texts_.row_of(std::string(text)));
    }
    void code_text(InputColumn<std::uint32_t>& column, std::string& text) const {
        std::uint32_t row = none;
        column(row);
        text = texts_.value(row);
    }
    /// `text` stays valid as long as this object.
    void code_text(InputColumn<std::uint32_t>& column, const char*& text) const {
        std::uint32_t row = none;
        column(row);
        text = texts_.value(row).c_str();
    }
    std::uint32_t vehicle(core::VehicleKey key) {
        const std::uint32_t row = keys_.row_of(key);
        if (row >= ids_.size()) ids_.resize(row + 1);
        return row;
    }
    core::VehicleKey key(std::uint32_t vehicle) const { return keys_.value(vehicle); }
    /// SUMO's id; empty for a vehicle that no roster knows.
    std::string& id(std::uint32_t vehicle) { return ids_.at(vehicle); }

    void write(TableWriter& file) const;
    void read(TableReader& file);
    /// Adds all names to the hash.
    void add_to(core::RunningHash& hash) const;

  private:
    Interned<core::VehicleKey> keys_;
    std::vector<std::string> ids_;
    Interned<std::string> texts_;
};

}  // namespace clearway::trace::detail
