#pragma once

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "core/ids.hpp"
#include "core/match_rows.hpp"

namespace clearway::trace::detail {

using core::no_row;

/// A column of numbers: `code(row)` codes one.
template <class Stream, class Code>
void column(Stream& stream, std::size_t rows, const Code& code) {
    stream.begin_column();
    for (std::uint32_t row = 0; row < rows; ++row)
        code(row);
    stream.end_column();
}

/// A list whose length is coded, too.
template <class Stream, class List, class Code>
void list(Stream& stream, List& elements, const Code& code) {
    if constexpr (Stream::reading) {
        elements.clear();
        elements.resize(stream.size());
    } else {
        stream.size(elements.size());
    }
    for (auto& element : elements)
        code(element);
}

/// The keys of an ascending list, as what left it and what joined it since the step before.
class KeyList {
  public:
    /// Keys of the present list, and the row that each had in the step before, or `no_row`.
    const std::vector<core::VehicleKey>& now() const { return now_; }
    const std::vector<std::uint32_t>& before() const { return before_; }

    /// Reading, `keys` becomes the list.
    template <class Stream, class Keys>
    void code(Stream& stream, Keys& keys) {
        std::swap(now_, last_);
        if constexpr (!Stream::reading) {
            now_.assign(keys.begin(), keys.end());
            require_ascending();
            find_changes();
        }
        std::uint32_t expected = 0;
        list(stream, gone_, [&](auto& row) {
            stream.number(row, expected);
            expected = row + 1;
        });
        list(stream, joined_, [&](auto& key) { stream.key(key); });
        if constexpr (Stream::reading) {
            apply_changes();
            keys = now_;
        }
        core::match_rows(now_, last_, before_);
    }

    /// Rows that carry their key: written, their keys; read, one row a key with nothing else in it yet.
    template <class Stream, class Rows>
    void code_rows(Stream& stream, Rows& rows) {
        std::vector<core::VehicleKey> keys;
        for (const auto& row : rows)
            keys.push_back(row.key);
        code(stream, keys);
        if constexpr (Stream::reading) {
            rows.assign(keys.size(), {});
            for (std::size_t row = 0; row < keys.size(); ++row)
                rows[row].key = keys[row];
        }
    }

  private:
    void require_ascending() const {
        for (std::size_t i = 1; i < now_.size(); ++i) {
            if (!(now_[i - 1] < now_[i])) throw std::invalid_argument("rows are not ordered by key");
        }
    }
    void find_changes() {
        gone_.clear();
        joined_.clear();
        core::match_rows(last_, now_, before_);
        for (std::uint32_t row = 0; row < last_.size(); ++row) {
            if (before_[row] == no_row) gone_.push_back(row);
        }
        core::match_rows(now_, last_, before_);
        for (std::uint32_t row = 0; row < now_.size(); ++row) {
            if (before_[row] == no_row) joined_.push_back(now_[row]);
        }
    }
    void apply_changes() {
        now_.clear();
        auto gone = gone_.begin();
        auto joined = joined_.begin();
        for (std::uint32_t row = 0; row < last_.size(); ++row) {
            if (gone != gone_.end() && *gone == row) {
                ++gone;
                continue;
            }
            for (; joined != joined_.end() && *joined < last_[row]; ++joined)
                now_.push_back(*joined);
            now_.push_back(last_[row]);
        }
        now_.insert(now_.end(), joined, joined_.end());
        if (gone != gone_.end()) throw std::runtime_error("a vehicle left that was not there");
        for (std::size_t i = 1; i < now_.size(); ++i) {
            if (!(now_[i - 1] < now_[i])) throw std::runtime_error("vehicles are not ordered");
        }
    }

    std::vector<core::VehicleKey> now_, last_, joined_;
    std::vector<std::uint32_t> before_, gone_;
};

template <class Stream, class Keys>
void code_keys(Stream& stream, Keys& keys) {
    list(stream, keys, [&](auto& key) { stream.key(key); });
}

}  // namespace clearway::trace::detail
