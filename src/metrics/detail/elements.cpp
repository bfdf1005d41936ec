#include "metrics/detail/elements.hpp"

#include <exception>
#include <new>
#include <stdexcept>

#include <fmt/format.h>

#include "core/number.hpp"

namespace clearway::metrics::detail {
namespace {

class Visitor : public core::XmlHandler {
  public:
    Visitor(const std::filesystem::path& file, const std::function<void(const Element&)>& visit)
        : file_(file), visit_(visit) {}

    void start(std::string_view name, const core::XmlAttributes& attributes, unsigned long line) override {
        try {
            visit_(Element(name, attributes));
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const std::exception& error) {
            throw std::runtime_error(fmt::format("{}:{}: {}", file_.string(), line, error.what()));
        }
    }
    void end(std::string_view) override {}

  private:
    const std::filesystem::path& file_;
    const std::function<void(const Element&)>& visit_;
};

}  // namespace

double Element::number(std::string_view attribute) const {
    const std::string_view word = text(attribute);
    if (const auto value = core::number_from(word)) return *value;
    throw std::invalid_argument(fmt::format("{}: {}=\"{}\" is not a number", name_, attribute, word));
}

void for_each_element(const std::filesystem::path& file, const std::function<void(const Element&)>& visit) {
    Visitor visitor(file, visit);
    core::stream_xml(file, visitor);
}

}  // namespace clearway::metrics::detail
