"""Writes state dicts as torch.save does, without torch: Python's own pickler of protocol 2 with torch's names, in an archive
whose members are stored and start at multiples of 64 byte. Usage: write_pth.py FOLDER. Value k of tensor t (both from 0) of a
net is (100 t + k) / 128 - 3, which every format of numbers but bfloat16 holds exactly."""
import collections
import io
import os
import pickle
import struct
import sys
import types
import zipfile

folder = sys.argv[1]
OrderedDict = collections.OrderedDict


def module(name, **members):
    made = types.ModuleType(name)
    for key, value in members.items():
        if isinstance(value, (type, types.FunctionType)):
            value.__module__ = name
        setattr(made, key, value)
    sys.modules[name] = made
    return made


def named(text):
    def function(*_):
        raise RuntimeError("never called")
    function.__name__ = function.__qualname__ = text
    return function


FORMATS = {"FloatStorage": "f", "DoubleStorage": "d", "HalfStorage": "e", "LongStorage": "q", "BFloat16Storage": None}
storages = {name: type(name, (), {}) for name in FORMATS}
torch = module("torch", **storages)
utils = module("torch._utils", _rebuild_tensor_v2=named("_rebuild_tensor_v2"), _rebuild_parameter=named("_rebuild_parameter"))


class Storage:
    def __init__(self, kind, values, device="cpu"):
        self.kind, self.values, self.device = kind, values, device

    def content(self, order="<"):
        if self.kind == "BFloat16Storage":
            return b"".join(struct.pack("<f", value)[2:] for value in self.values)
        return struct.pack(f"{order}{len(self.values)}{FORMATS[self.kind]}", *self.values)


class Tensor:
    def __init__(self, storage, shape, strides=None, offset=0):
        self.storage, self.shape, self.offset = storage, shape, offset
        if strides is None:
            strides, step = [], 1
            for size in reversed(shape):
                strides.insert(0, step)
                step *= size
        self.strides = tuple(strides)

    def __reduce_ex__(self, protocol):
        return utils._rebuild_tensor_v2, (self.storage, self.offset, self.shape, self.strides, False, OrderedDict())


class Parameter:
    def __init__(self, tensor):
        self.tensor = tensor

    def __reduce_ex__(self, protocol):
        return utils._rebuild_parameter, (self.tensor, True, OrderedDict())


class Saved(pickle.Pickler):
    def __init__(self, stream, protocol):
        super().__init__(stream, protocol)
        self.storages = []

    def persistent_id(self, thing):
        if not isinstance(thing, Storage):
            return None
        if thing not in self.storages:
            self.storages.append(thing)
        key = str(self.storages.index(thing))
        return ("storage", getattr(torch, thing.kind), key, thing.device, len(thing.values))


class Unseekable:
    """zipfile then writes sizes behind the data (flag bit 3), as PyTorch does."""
    def __init__(self, stream):
        self.stream = stream

    def write(self, data):
        return self.stream.write(data)

    def flush(self):
        self.stream.flush()


def save(name, thing, protocol=2, compression=zipfile.ZIP_STORED, members=None, order="<", change=None, target=None):
    stream = io.BytesIO()
    pickler = Saved(stream, protocol)
    pickler.dump(thing)
    contents = [("data.pkl", stream.getvalue()), ("byteorder", b"little" if order == "<" else b"big")]
    contents += [(f"data/{key}", storage.content(order)) for key, storage in enumerate(pickler.storages)]
    contents += [("version", b"3\n"), (".data/serialization_id", b"0123456789")] + list(members or [])
    bytes_ = io.BytesIO()
    out = Unseekable(bytes_) if target is None else target(bytes_)
    with zipfile.ZipFile(out, "w", compression) as archive:
        for member, content in contents:
            info = zipfile.ZipInfo(f"{name}/{member}")
            info.compress_type = compression
            begin = bytes_.tell() + 30 + len(info.filename) + 4
            padding = -begin % 64
            info.extra = struct.pack("<HH", 0x4246, padding) + b"Z" * padding
            archive.writestr(info, content)
    data = bytearray(bytes_.getvalue())
    if change is not None:
        data = change(data)
    with open(f"{folder}/{name}.pth", "wb") as file:
        file.write(data)


def sage(inputs=5, hidden=10, output=5):
    return [("conv1.lin_l.weight", (hidden, inputs)), ("conv1.lin_l.bias", (hidden,)), ("conv1.lin_r.weight", (hidden, inputs)),
            ("conv2.lin_l.weight", (output, hidden)), ("conv2.lin_l.bias", (output,)), ("conv2.lin_r.weight", (output, hidden)),
            ("fc1.weight", (hidden, output)), ("fc1.bias", (hidden,)), ("fc2.weight", (1, hidden)), ("fc2.bias", (1,))]


def attention(kind, inputs=5, hidden=10, output=5):
    layers = []
    for layer, width, size in (("conv1", inputs, hidden), ("conv2", hidden, output)):
        if kind == "gat":
            layers += [(f"{layer}.att_src", (1, 1, size)), (f"{layer}.att_dst", (1, 1, size))]
        layers += [(f"{layer}.bias", (size,)), (f"{layer}.lin.weight", (size, width))]
    return layers + sage(inputs, hidden, output)[6:]


def net(shapes, prefix=("graphsage.", "nn."), kind="FloatStorage", wrap=lambda tensor: tensor, device="cpu"):
    state = OrderedDict()
    for t, (name, shape) in enumerate(shapes):
        count = 1
        for size in shape:
            count *= size
        values = [(100 * t + k) / 128 - 3 for k in range(count)]
        before = prefix[0] if name.startswith("conv") else prefix[1]
        state[before + name] = wrap(Tensor(Storage(kind, values, device), shape))
    state._metadata = OrderedDict([("", {"version": 1}), ("graphsage", {"version": 1})])
    return state


def changed(**values):
    state = net(sage())
    for name, value in values.items():
        state[name] = value
    return state


good = net(sage())
save("good", good)
save("plain_dict", dict(good))
save("two_features", net(sage(inputs=2)))
save("parameters", net(sage(), wrap=Parameter))
save("half", net(sage(), kind="HalfStorage"))
save("double", net(sage(), kind="DoubleStorage"))
save("bfloat16", net(sage(), kind="BFloat16Storage"))
save("cuda", net(sage(), device="cuda:0"))
save("parallel", net(sage(), prefix=("module.encoder.", "module.decoder.")))
save("seekable", good, target=lambda stream: stream)
save("gcn", net(attention("gcn")))
save("gat", net(attention("gat")))

# lin_l.weight of conv1 as the transposed second half of a storage that it shares with nobody else's view.
strided = net(sage())
plain = strided["graphsage.conv1.lin_l.weight"].storage.values
turned = [0.0] * 50 + [plain[row * 5 + column] for column in range(5) for row in range(10)]
strided["graphsage.conv1.lin_l.weight"] = Tensor(Storage("FloatStorage", turned), (10, 5), (1, 10), 50)
save("strided", strided)


def with_zip64_end(data):
    """PyTorch writes a zip64 end of the directory in every archive, however small."""
    end = data.rindex(b"PK\x05\x06")
    count, size, offset = struct.unpack("<HII", data[end + 10:end + 20])
    record = struct.pack("<IQHHIIQQQQ", 0x06064b50, 44, 45, 45, 0, 0, count, count, size, offset)
    locator = struct.pack("<IIQI", 0x07064b50, 0, end, 1)
    return data[:end] + record + locator + data[end:]


save("zip64_end", good, change=with_zip64_end)

# What is refused.


class Attack:
    def __reduce_ex__(self, protocol):
        return os.system, (f"touch {folder}/was_run",)


class GraphSAGENet:
    pass


save("attack", OrderedDict([("graphsage.conv1.lin_l.weight", Attack())]))
save("whole_model", GraphSAGENet())
save("checkpoint", {"model_state_dict": good, "epoch": 3, "loss": 0.25, "history": [1.5, None, True]})
save("list", [1, 2, 3])
save("empty", OrderedDict())
save("three_features", net(sage(inputs=3)))
save("not_a_number", changed(**{"nn.fc1.bias": Tensor(Storage("FloatStorage", [0.0] * 4 + [float("nan")] * 6), (10,))}))
save("infinite_half", changed(**{"nn.fc1.bias": Tensor(Storage("HalfStorage", [float("inf")] * 10), (10,))}))
save("whole_numbers", changed(**{"nn.fc1.bias": Tensor(Storage("LongStorage", [1] * 10), (10,))}))
save("out_of_storage", changed(**{"nn.fc1.bias": Tensor(Storage("FloatStorage", [1.0] * 10), (10,), (2,))}))
save("before_storage", changed(**{"nn.fc1.bias": Tensor(Storage("FloatStorage", [1.0] * 10), (10,), (1,), -1)}))
save("huge", changed(**{"nn.fc1.bias": Tensor(Storage("FloatStorage", [1.0]), (1 << 40, 1 << 40), (0, 0))}))
save("wide", changed(**{"nn.fc1.bias": Tensor(Storage("FloatStorage", [1.0] * 11), (11,))}))
missing = net(sage())
del missing["nn.fc2.bias"]
save("missing_key", missing)
save("extra_key", changed(**{"graphsage.conv3.bias": Tensor(Storage("FloatStorage", [1.0]), (1,))}))
save("compressed", good, compression=zipfile.ZIP_DEFLATED)
save("big_endian", good, order=">")
save("protocol_4", good, protocol=4)
save("script", good, members=[("constants.pkl", b"\x80\x02).")])
save("twice", good, members=[("data/0", b"1234")])


def damaged(data):
    at = data.index(b"damaged/data/3") + 200
    data[at] ^= 1
    return data


save("damaged", good, change=damaged)
with open(f"{folder}/old.pth", "wb") as file:
    pickle.dump(0x1950a86a20f9469cfc6c, file, protocol=2)
    pickle.dump(1001, file, protocol=2)
with open(f"{folder}/text.pth", "w", encoding="ascii") as file:
    file.write("not an archive\n")
open(f"{folder}/nothing.pth", "w", encoding="ascii").close()
