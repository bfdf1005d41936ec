#include "prediction/detail/pickle.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <iterator>
#include <optional>
#include <unordered_map>

#include <fmt/format.h>

#include "core/error.hpp"
#include "prediction/detail/bytes.hpp"

namespace clearway::prediction::detail {
namespace {

using Reference = PickleValue::Reference;
using Global = PickleValue::Global;
using Sequence = PickleValue::Sequence;
using Dict = PickleValue::Dict;

constexpr const char* save_state_dict = "Save the parameters alone: torch.save(model.state_dict(), file)";
constexpr std::size_t most_axes = 8;
constexpr std::size_t most_bytes = 1 << 20;  // A parameter takes about 150.

bool is(const Global& global, std::string_view module, std::string_view name) {
    return global.module == module && global.name == name;
}
bool is_storage(const Global& global) {
    return global.module == "torch" && global.name.ends_with("Storage");
}
bool is_known(const Global& global) {
    return is(global, "collections", "OrderedDict") || is(global, "torch._utils", "_rebuild_tensor_v2") ||
           is(global, "torch._utils", "_rebuild_parameter") ||
           // libtorch marks its dicts with the type of their values.
           is(global, "torch.jit._pickle", "restore_type_tag") || is_storage(global);
}

/// The stack machine of a pickle.
class Machine {
  public:
    Machine(std::string_view bytes, const std::string& source) : bytes_(bytes), source_(source) {}

    PickleDocument run() {
        if (bytes_.size() > most_bytes)
            fail(fmt::format("has {} bytes", bytes_.size()), fmt::format("{} at most", most_bytes),
                 save_state_dict);
        if (byte() != 0x80) refuse("does not start as a pickle of protocol 2");
        if (const unsigned protocol = byte(); protocol != 2)
            fail(fmt::format("is a pickle of protocol {}", protocol), "protocol 2",
                 "Save it again without pickle_protocol");
        while (step()) {
        }
        document_.top = pop();
        if (!stack_.empty()) refuse("leaves values behind");
        return std::move(document_);
    }

  private:
    [[noreturn]] void fail(const std::string& what, const std::string& allowed,
                           const std::string& cure) const {
        throw core::InputError({fmt::format("{}: data.pkl", source_), what, allowed, cure});
    }
    [[noreturn]] void refuse(const std::string& what) const {
        fail(fmt::format("{} (byte {})", what, at_), "", save_state_dict);
    }

    template <class Number>
    Number number() {
        const std::optional<Number> value = number_at<Number>(bytes_, at_);
        if (!value) refuse("is cut off");
        at_ += sizeof(Number);
        return *value;
    }
    unsigned byte() { return number<std::uint8_t>(); }
    std::string text(std::size_t length) {
        const std::optional<std::string_view> part = part_of(bytes_, at_, length);
        if (!part) refuse("is cut off");
        at_ += length;
        return std::string(*part);
    }
    std::string line() {
        const std::size_t stop = bytes_.find('\n', at_);
        if (stop == std::string_view::npos) refuse("is cut off");
        std::string found(bytes_.substr(at_, stop - at_));
        at_ = stop + 1;
        return found;
    }

    template <class Content>
    void push(Content content) {
        document_.values.push_back({std::move(content)});
        stack_.push_back(static_cast<Reference>(document_.values.size() - 1));
    }
    /// Never takes what stands below the last mark.
    Reference pop() {
        if (stack_.size() <= (marks_.empty() ? 0 : marks_.back())) refuse("takes a value where none is");
        const Reference last = stack_.back();
        stack_.pop_back();
        return last;
    }
    std::vector<Reference> pop_to_mark() {
        if (marks_.empty()) refuse("has no mark where one belongs");
        const std::vector<Reference> items(stack_.begin() + static_cast<std::ptrdiff_t>(marks_.back()),
                                           stack_.end());
        stack_.resize(marks_.back());
        marks_.pop_back();
        return items;
    }
    Reference top() const {
        if (stack_.size() <= (marks_.empty() ? 0 : marks_.back())) refuse("takes a value where none is");
        return stack_.back();
    }
    template <class Content>
    Content& get(Reference reference, const char* what) {
        auto* const found = std::get_if<Content>(&document_.values[reference].content);
        if (found == nullptr) refuse(fmt::format("has something else where {} belongs", what));
        return *found;
    }

    struct Opcode {
        unsigned char code;
        void (*run)(Machine& machine);
    };
    static const Opcode opcodes[];

    bool step();
    void memoize(std::uint32_t place) { memo_[place] = top(); }
    void recall(std::uint32_t place);
    void tuple(std::size_t size);
    void set_item();
    /// Attributes of an OrderedDict, where PyTorch keeps versions of its modules.
    void build();
    void set_items(const std::vector<Reference>& items);
    void append(const std::vector<Reference>& items);
    void push_global();
    void push_long();
    void load_storage();
    void reduce();
    PickledTensor rebuilt_tensor(const Sequence& arguments);
    std::vector<std::int64_t> sizes_in(Reference reference);

    std::string_view bytes_;
    const std::string& source_;
    std::size_t at_ = 0;
    PickleDocument document_;
    std::vector<Reference> stack_;
    std::vector<std::size_t> marks_;
    std::unordered_map<std::uint32_t, Reference> memo_;
};

/// By the names of `pickletools`.
const Machine::Opcode Machine::opcodes[] = {
    {'N', [](Machine& m) { m.push(PickleValue::None{}); }},
    {0x88, [](Machine& m) { m.push(true); }},
    {0x89, [](Machine& m) { m.push(false); }},
    {'J', [](Machine& m) { m.push(std::int64_t{m.number<std::int32_t>()}); }},   // BININT
    {'K', [](Machine& m) { m.push(std::int64_t{m.number<std::uint8_t>()}); }},   // BININT1
    {'M', [](Machine& m) { m.push(std::int64_t{m.number<std::uint16_t>()}); }},  // BININT2
    {0x8a, [](Machine& m) { m.push_long(); }},                                   // LONG1
    {'G',                                                                        // BINFLOAT, big-endian
     [](Machine& m) { m.push(std::bit_cast<double>(__builtin_bswap64(m.number<std::uint64_t>()))); }},
    {'X', [](Machine& m) { m.push(m.text(m.number<std::uint32_t>())); }},  // BINUNICODE
    {'c', [](Machine& m) { m.push_global(); }},
    {'(', [](Machine& m) { m.marks_.push_back(m.stack_.size()); }},
    {'}', [](Machine& m) { m.push(Dict{}); }},
    {']', [](Machine& m) { m.push(Sequence{}); }},
    {')', [](Machine& m) { m.push(Sequence{}); }},
    {'t', [](Machine& m) { m.push(Sequence{m.pop_to_mark()}); }},
    {0x85, [](Machine& m) { m.tuple(1); }},
    {0x86, [](Machine& m) { m.tuple(2); }},
    {0x87, [](Machine& m) { m.tuple(3); }},
    {'s', [](Machine& m) { m.set_item(); }},
    {'u', [](Machine& m) { m.set_items(m.pop_to_mark()); }},
    {'a', [](Machine& m) { m.append({m.pop()}); }},
    {'e', [](Machine& m) { m.append(m.pop_to_mark()); }},
    {'q', [](Machine& m) { m.memoize(m.byte()); }},
    {'r', [](Machine& m) { m.memoize(m.number<std::uint32_t>()); }},
    {'h', [](Machine& m) { m.recall(m.byte()); }},
    {'j', [](Machine& m) { m.recall(m.number<std::uint32_t>()); }},
    {'Q', [](Machine& m) { m.load_storage(); }},
    {'R', [](Machine& m) { m.reduce(); }},
    {'b', [](Machine& m) { m.build(); }},
};

bool Machine::step() {
    const unsigned opcode = byte();
    if (opcode == '.') return false;  // STOP
    const auto* const found = std::ranges::find(opcodes, opcode, &Opcode::code);
    if (found == std::end(opcodes))
        refuse(fmt::format("has an opcode {:#04x}, which no state dict needs", opcode));
    found->run(*this);
    return true;
}

void Machine::recall(std::uint32_t place) {
    const auto found = memo_.find(place);
    if (found == memo_.end()) refuse("recalls a value that it did not keep");
    stack_.push_back(found->second);
}

void Machine::tuple(std::size_t size) {
    std::vector<Reference> items(size);
    for (std::size_t at = size; at-- > 0;)
        items[at] = pop();
    push(Sequence{std::move(items)});
}

void Machine::set_item() {
    const Reference value = pop();
    set_items({pop(), value});
}

void Machine::build() {
    pop();
    get<Dict>(top(), "a dict");
}

void Machine::set_items(const std::vector<Reference>& items) {
    if (items.size() % 2 != 0) refuse("has a key without a value");
    auto& dict = get<Dict>(top(), "a dict");
    for (std::size_t at = 0; at < items.size(); at += 2)
        dict.items.emplace_back(items[at], items[at + 1]);
}

void Machine::append(const std::vector<Reference>& items) {
    auto& list = get<Sequence>(top(), "a list");
    list.items.insert(list.items.end(), items.begin(), items.end());
}

void Machine::push_global() {
    const std::string module = line();
    Global global{module, line()};
    if (!is_known(global))
        fail(fmt::format("names {}.{}, which no state dict needs; it was not loaded and not run",
                         global.module, global.name),
             "tensors in a dict", save_state_dict);
    push(std::move(global));
}

/// A whole number of so many bytes, the lowest first, with the sign in the last.
void Machine::push_long() {
    const unsigned length = byte();
    if (length > 8) refuse("has a number beyond 64 bits");
    const std::string raw = text(length);
    std::uint64_t value = !raw.empty() && (raw.back() & 0x80) != 0 ? ~std::uint64_t{0} : 0;
    for (std::size_t at = raw.size(); at-- > 0;)
        value = (value << 8) | static_cast<unsigned char>(raw[at]);
    push(static_cast<std::int64_t>(value));
}

/// BINPERSID: ('storage', type, key, device, count).
void Machine::load_storage() {
    const std::vector<Reference> items = get<Sequence>(pop(), "a storage").items;
    if (items.size() != 5 || get<std::string>(items[0], "a storage") != "storage")
        refuse("has something else where a storage belongs");
    const auto& type = get<Global>(items[1], "a type of storage");
    if (!is_storage(type)) refuse("has something else where a type of storage belongs");
    push(PickledStorage{type.name, get<std::string>(items[2], "the key of a storage"),
                        get<std::int64_t>(items[4], "the size of a storage")});
}

/// Calls of the known globals; what they make is made here.
void Machine::reduce() {
    const Sequence arguments = get<Sequence>(pop(), "a tuple of arguments");
    const Global function = get<Global>(pop(), "a function");
    if (function.name == "OrderedDict" && arguments.items.empty()) {
        push(Dict{});
    } else if (function.name == "_rebuild_tensor_v2") {
        push(rebuilt_tensor(arguments));
    } else if (function.name == "_rebuild_parameter" && arguments.items.size() == 3) {
        push(get<PickledTensor>(arguments.items[0], "a tensor"));
    } else if (function.name == "restore_type_tag" && arguments.items.size() == 2) {
        get<Dict>(arguments.items[0], "a dict");
        stack_.push_back(arguments.items[0]);
    } else {
        refuse(fmt::format("calls {} with {} arguments", function.name, arguments.items.size()));
    }
}

/// (storage, offset, shape, strides, requires_grad, hooks, and metadata in newer files)
PickledTensor Machine::rebuilt_tensor(const Sequence& arguments) {
    if (arguments.items.size() < 6 || arguments.items.size() > 7)
        refuse(fmt::format("makes a tensor of {} arguments", arguments.items.size()));
    return {get<PickledStorage>(arguments.items[0], "a storage"),
            get<std::int64_t>(arguments.items[1], "the place of a tensor"), sizes_in(arguments.items[2]),
            sizes_in(arguments.items[3])};
}

std::vector<std::int64_t> Machine::sizes_in(Reference reference) {
    const auto& shape = get<Sequence>(reference, "a shape");
    if (shape.items.size() > most_axes) refuse(fmt::format("has a tensor of {} axes", shape.items.size()));
    std::vector<std::int64_t> sizes;
    for (const Reference item : shape.items)
        sizes.push_back(get<std::int64_t>(item, "a size"));
    return sizes;
}

// Pieces of a pickle that is written.

std::string integer(std::size_t value) {
    assert(value <= 0x7fffffffU);  // BININT is signed.
    std::string bytes = "J";
    append_number(bytes, static_cast<std::uint32_t>(value));
    return bytes;
}

std::string text(std::string_view value) {
    std::string bytes = "X";
    append_number(bytes, static_cast<std::uint32_t>(value.size()));
    return bytes.append(value);
}

std::string tuple(const std::vector<std::uint32_t>& values) {
    std::string bytes = "(";
    for (const std::uint32_t value : values)
        bytes += integer(value);
    return bytes + "t";
}

/// torch._utils._rebuild_tensor_v2(storage, offset, shape, strides, requires_grad, backward_hooks)
std::string tensor_of(const Tensor& tensor, std::size_t storage) {
    std::vector<std::uint32_t> strides(tensor.shape.size(), 1);
    for (std::size_t axis = strides.size(); axis-- > 1;)
        strides[axis - 1] = strides[axis] * tensor.shape[axis];
    return "ctorch._utils\n_rebuild_tensor_v2\n((" + text("storage") + "ctorch\nFloatStorage\n" +
           text(std::to_string(storage)) + text("cpu") + integer(tensor.values.size()) + "tQ" + integer(0) +
           tuple(tensor.shape) + tuple(strides) + "\x89" + "ccollections\nOrderedDict\n)RtR";
}

}  // namespace

PickleDocument read_pickle(std::string_view bytes, const std::string& source) {
    return Machine(bytes, source).run();
}

std::string format_pickle(const std::vector<Tensor>& tensors) {
    std::string bytes = "\x80\x02}(";  // PROTO 2, an empty dict, a mark
    for (std::size_t storage = 0; storage < tensors.size(); ++storage)
        bytes += text(tensors[storage].name) + tensor_of(tensors[storage], storage);
    return bytes + "u.";
}

}  // namespace clearway::prediction::detail
