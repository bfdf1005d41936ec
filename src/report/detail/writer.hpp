#pragma once

#include <ostream>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "report/detail/markup.hpp"

namespace clearway::report::detail {

/// Where sections write to: a page, or files of figures and tables. Names of figures and tables become file
/// names: lower case, made of letters, digits and hyphens, and unique.
class Writer {
  public:
    virtual ~Writer() = default;

    /// Prose and what groups figures: whatever is neither a figure nor a table.
    virtual void markup(std::string_view html) = 0;

    /// Nothing for a figure without a drawing.
    void figure(Figure figure);
    /// Side by side if there is room; nothing if none has a drawing.
    void figures(std::vector<Figure> figures);
    /// Nothing for a table without rows. Of tables and of the data of figures, columns without a value are
    /// left out.
    void table(Table table);

    virtual void heading(const std::string& text);
    /// Begins a part that readers unfold by a click and that print shows; `summary` is markup.
    void open_fold(const std::string& summary);
    void close_fold();

  protected:
    /// As names of files are, but perhaps not unique.
    static std::string plain_name(const std::string& wanted);

  private:
    virtual void put(const Figure& figure) = 0;
    virtual void put(const Table& table) = 0;
    std::string file_name(const std::string& wanted);

    std::set<std::string> names_;
};

/// Writes a page.
class PageWriter : public Writer {
  public:
    /// The stream outlives the writer.
    explicit PageWriter(std::ostream& page) : page_(page) {}
    void markup(std::string_view html) override { page_ << html; }

  private:
    void put(const Figure& figure) override { page_ << to_html(figure); }
    void put(const Table& table) override { page_ << to_html(table); }

    std::ostream& page_;
};

}  // namespace clearway::report::detail
