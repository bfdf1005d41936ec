#include "training/detail/sample_parts.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace clearway::training::detail {

void require_both_classes(const LabelCounts& counts, const char* part) {
    if (counts.linked > 0 && counts.unlinked > 0) return;
    const bool empty = counts.linked + counts.unlinked == 0;
    throw core::InputError({"--data",
                            empty ? fmt::format("the {} seeds hold no candidate pair", part)
                                  : fmt::format("the {} seeds hold only pairs that are {}linked", part,
                                                counts.linked > 0 ? "" : "not "),
                            "linked and unlinked pairs in each part",
                            "Record denser traffic, a sensor failure, or more seeds"});
}

}  // namespace clearway::training::detail
