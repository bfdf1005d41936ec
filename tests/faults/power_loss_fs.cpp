// A file system in memory that loses power: mounted with FUSE, for tests only.
//
//     power_loss_fs FOLDER
//
// stays in the foreground until `fusermount3 -u FOLDER`. It keeps what programs see, and what is on the disk:
// fsync puts the content of a file there, and of a folder its entries. The file /.power, which no listing
// shows, is its switch. Reading it gives the number of changes so far. Writing `sync` puts everything on the
// disk. Writing `cut N SEED` makes power fail at the N-th change from now: this call and all that follow end
// with EIO. Writing `on` lets power return. Of what was not flushed, each folder then has its old entries or
// the new ones, and each file its old content, the new one or a part of it, drawn by SEED.
#define FUSE_USE_VERSION 31

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <map>
#include <memory>
#include <random>
#include <sstream>
#include <string>

#include <fuse3/fuse.h>

namespace {

struct Node;
using Entries = std::map<std::string, std::shared_ptr<Node>>;

struct Node {
    mode_t mode = 0;
    std::timespec changed{};
    std::string content, content_on_disk;
    Entries entries, entries_on_disk;

    bool is_folder() const { return S_ISDIR(mode); }
};

struct Place {
    std::shared_ptr<Node> folder;
    std::string name;
};

class Disk {
  public:
    Disk() { root_->mode = S_IFDIR | 0755U; }

    bool is_off() const { return is_off_; }
    std::uint64_t changes() const { return changes_; }

    /// Counts a change; false when power fails at it.
    bool change() {
        ++changes_;
        if (left_ > 0 && --left_ == 0) is_off_ = true;
        return !is_off_;
    }
    void cut_after(std::uint64_t changes, std::uint64_t seed) {
        left_ = changes;
        is_off_ = changes == 0;
        draw_.seed(seed);
    }
    void flush_all() { flush(*root_); }
    void power_on() {
        if (is_off_) forget(*root_);
        is_off_ = false;
        left_ = 0;
    }

    std::shared_ptr<Node> find(const std::string& path) const {
        std::shared_ptr<Node> node = root_;
        std::istringstream parts(path);
        for (std::string part; std::getline(parts, part, '/');) {
            if (part.empty()) continue;
            const auto entry = node->entries.find(part);
            if (entry == node->entries.end()) return nullptr;
            node = entry->second;
        }
        return node;
    }
    Place place(const std::string& path) const {
        const std::size_t slash = path.rfind('/');
        return {find(path.substr(0, slash)), path.substr(slash + 1)};
    }

  private:
    void flush(Node& node) {
        node.content_on_disk = node.content;
        node.entries_on_disk = node.entries;
        for (const auto& [name, below] : node.entries)
            flush(*below);
    }
    void forget(Node& node) {
        if (!node.is_folder()) {
            const auto fate = draw_() % 3;
            if (fate == 0) node.content = node.content_on_disk;
            if (fate == 1 && node.content != node.content_on_disk)
                node.content.resize(node.content.empty() ? 0 : draw_() % node.content.size());
            node.content_on_disk = node.content;
            return;
        }
        if (draw_() % 2 == 0) node.entries = node.entries_on_disk;
        node.entries_on_disk = node.entries;
        for (const auto& [name, below] : node.entries)
            forget(*below);
    }

    std::shared_ptr<Node> root_ = std::make_shared<Node>();
    std::uint64_t changes_ = 0, left_ = 0;
    bool is_off_ = false;
    std::mt19937_64 draw_;
};

Disk disk;
constexpr const char* power = "/.power";

void touch(Node& node) {
    std::timespec_get(&node.changed, TIME_UTC);
}

int get_attributes(const char* path, struct stat* attributes, fuse_file_info*) {
    *attributes = {};
    if (std::strcmp(path, power) == 0) {
        attributes->st_mode = S_IFREG | 0600U;
        attributes->st_nlink = 1;
        return 0;
    }
    if (disk.is_off()) return -EIO;
    const auto node = disk.find(path);
    if (!node) return -ENOENT;
    attributes->st_mode = node->mode;
    attributes->st_nlink = 1;
    attributes->st_size = static_cast<off_t>(node->content.size());
    attributes->st_mtim = attributes->st_ctim = attributes->st_atim = node->changed;
    return 0;
}

int list(const char* path, void* buffer, fuse_fill_dir_t fill, off_t, fuse_file_info*, fuse_readdir_flags) {
    if (disk.is_off()) return -EIO;
    for (const char* const name : {".", ".."})
        fill(buffer, name, nullptr, 0, {});
    for (const auto& [name, node] : disk.find(path)->entries)
        fill(buffer, name.c_str(), nullptr, 0, {});
    return 0;
}

int add(const char* path, mode_t mode) {
    if (!disk.change()) return -EIO;
    const Place place = disk.place(path);
    if (!place.folder) return -ENOENT;
    auto node = std::make_shared<Node>();
    node->mode = mode;
    touch(*node);
    touch(*place.folder);
    place.folder->entries[place.name] = std::move(node);
    return 0;
}

int make_folder(const char* path, mode_t mode) {
    return add(path, mode | S_IFDIR);
}

int create(const char* path, mode_t mode, fuse_file_info*) {
    return add(path, mode | S_IFREG);
}

int open_file(const char* path, fuse_file_info* info) {
    if (std::strcmp(path, power) == 0) {
        info->direct_io = 1;
        return 0;
    }
    if (disk.is_off()) return -EIO;
    return disk.find(path) ? 0 : -ENOENT;
}

int read_file(const char* path, char* buffer, size_t size, off_t offset, fuse_file_info*) {
    const auto start = static_cast<std::size_t>(offset);
    const bool is_power = std::strcmp(path, power) == 0;
    if (disk.is_off() && !is_power) return -EIO;
    const std::string content = is_power ? std::to_string(disk.changes()) : disk.find(path)->content;
    if (start >= content.size()) return 0;
    return static_cast<int>(content.copy(buffer, size, start));
}

int write_power(const std::string& text) {
    std::istringstream words(text);
    std::string word;
    std::uint64_t changes = 0;
    std::uint64_t seed = 0;
    words >> word >> changes >> seed;
    if (word == "cut") disk.cut_after(changes, seed);
    if (word == "sync") disk.flush_all();
    if (word == "on") disk.power_on();
    return static_cast<int>(text.size());
}

int write_file(const char* path, const char* bytes, size_t size, off_t offset, fuse_file_info*) {
    if (std::strcmp(path, power) == 0) return write_power({bytes, size});
    if (!disk.change()) return -EIO;
    const auto node = disk.find(path);
    if (!node) return -ENOENT;
    const auto start = static_cast<std::size_t>(offset);
    if (node->content.size() < start + size) node->content.resize(start + size);
    node->content.replace(start, size, bytes, size);
    touch(*node);
    return static_cast<int>(size);
}

int truncate_file(const char* path, off_t size, fuse_file_info*) {
    if (std::strcmp(path, power) == 0) return 0;
    if (!disk.change()) return -EIO;
    const auto node = disk.find(path);
    if (!node) return -ENOENT;
    node->content.resize(static_cast<std::size_t>(size));
    touch(*node);
    return 0;
}

int flush_file(const char* path, int, fuse_file_info*) {
    if (!disk.change()) return -EIO;
    const auto node = disk.find(path);
    if (!node) return -ENOENT;
    node->content_on_disk = node->content;
    node->entries_on_disk = node->entries;
    return 0;
}

int remove_entry(const char* path) {
    if (!disk.change()) return -EIO;
    const Place place = disk.place(path);
    if (!place.folder || place.folder->entries.erase(place.name) == 0) return -ENOENT;
    touch(*place.folder);
    return 0;
}

int remove_folder(const char* path) {
    const auto node = disk.find(path);
    if (node && !node->entries.empty()) return -ENOTEMPTY;
    return remove_entry(path);
}

int rename_entry(const char* from, const char* to, unsigned flags) {
    if (!disk.change()) return -EIO;
    if (flags != 0) return -EINVAL;
    const Place source = disk.place(from);
    const Place target = disk.place(to);
    const auto node = disk.find(from);
    if (!node || !target.folder) return -ENOENT;
    const auto there = disk.find(to);
    if (there && there->is_folder() && !there->entries.empty()) return -ENOTEMPTY;
    source.folder->entries.erase(source.name);
    target.folder->entries[target.name] = node;
    touch(*source.folder);
    touch(*target.folder);
    return 0;
}

int link_file(const char* from, const char* to) {
    if (!disk.change()) return -EIO;
    const auto node = disk.find(from);
    const Place target = disk.place(to);
    if (!node || !target.folder) return -ENOENT;
    target.folder->entries[target.name] = node;
    touch(*target.folder);
    return 0;
}

int change_mode(const char* path, mode_t mode, fuse_file_info*) {
    if (!disk.change()) return -EIO;
    const auto node = disk.find(path);
    if (!node) return -ENOENT;
    node->mode = (node->mode & static_cast<mode_t>(S_IFMT)) | (mode & ~static_cast<mode_t>(S_IFMT));
    return 0;
}

int change_times(const char* path, const timespec times[2], fuse_file_info*) {
    const auto node = disk.find(path);
    if (!node) return -ENOENT;
    node->changed = times[1];
    return 0;
}

/// Nothing is kept by the kernel, which would outlive the power.
void* start(fuse_conn_info*, fuse_config* config) {
    config->kernel_cache = 0;
    config->entry_timeout = config->attr_timeout = config->negative_timeout = 0.0;
    config->hard_remove = 1;
    return nullptr;
}

}  // namespace

int main(int count, char** words) {
    if (count != 2) return 2;
    fuse_operations operations{};
    operations.init = start;
    operations.getattr = get_attributes;
    operations.readdir = list;
    operations.mkdir = make_folder;
    operations.create = create;
    operations.open = open_file;
    operations.read = read_file;
    operations.write = write_file;
    operations.truncate = truncate_file;
    operations.fsync = flush_file;
    operations.fsyncdir = flush_file;
    operations.unlink = remove_entry;
    operations.rmdir = remove_folder;
    operations.rename = rename_entry;
    operations.link = link_file;
    operations.chmod = change_mode;
    operations.utimens = change_times;
    std::string single = "-s";
    std::string foreground = "-f";
    char* arguments[] = {words[0], single.data(), foreground.data(), words[1], nullptr};
    return fuse_main(4, arguments, &operations, nullptr);
}
