"""Data sets as edge lists: files written by hand, byte by byte, against what is read."""
import errno
import json
import os
import struct
import unittest
from pathlib import Path
from unittest import mock

import clearway
import numpy as np
from clearway._files import _xxhash, content_hash
from support import FolderCase, told_when

ORIGIN = {"scenario": "s", "failure": "B10", "feature_name": "corrected", "feature_version": 2, "feature_count": 2,
          "study_seed": 1, "replication": 3, "link_radius_m": 50.0}

PUBLISHED = {"edge_list.csv": "0,1\n2,2\n", "vehicle_features.csv": "1.5,2\n3,4\n5,6\n", "target_y.csv": "1,0\n"}


def sealed(content: bytes, samples: int) -> bytes:
    return content + b"\nend %d %s\n" % (samples, content_hash([content]).encode())


def sample_file(samples: int = 2, version: int = 1, last: int = 2) -> bytes:
    content = b"clearway graph samples %d\n" % version + json.dumps(ORIGIN).encode() + b"\n"
    for number in range(samples):
        content += struct.pack("<dIII", 10.0 + number, 3, 1, 2)
        content += struct.pack("<6f", 1, 2, 3, 4, 5, 6) + struct.pack("<2I", 0, 2)
        content += struct.pack("<IIfB", 0, 1, 40.0, 1) + struct.pack("<IIfB", 1, last, 70.0, 0)
    return sealed(content, samples)


class DatasetTest(FolderCase):
    def write_published(self) -> None:
        for name, text in PUBLISHED.items():
            Path(name).write_text(text)

    def test_samples_become_edge_lists(self) -> None:
        (self.folder / "s-B10-0003.samples").write_bytes(sample_file())
        first, second = clearway.dataset(self.folder)
        np.testing.assert_array_equal(first.x, [[1, 2], [3, 4], [5, 6]])
        np.testing.assert_array_equal(first.edge_index, [[0, 2], [2, 0]])
        np.testing.assert_array_equal(first.edge_label_index, [[0, 1], [1, 2]])
        np.testing.assert_array_equal(first.edge_label, [1, 0])
        np.testing.assert_array_equal(first.edge_label_attr, [[40], [70]])
        self.assertEqual([str(array.dtype) for array in first.arrays().values()], ["float32", "int64", "int64", "float32", "float32"])
        self.assertEqual((second.origin["time_s"], second.origin["failure"]), (11.0, "B10"))

    def test_published_files_become_one_graph(self) -> None:
        self.write_published()
        (only,) = clearway.dataset(self.folder)
        np.testing.assert_array_equal(only.edge_label_index, [[0, 1], [2, 2]])
        np.testing.assert_array_equal(only.edge_index, [[0, 1, 2, 2], [2, 2, 0, 1]])
        np.testing.assert_array_equal(only.x, [[1.5, 2], [3, 4], [5, 6]])

    def test_bad_files_are_named(self) -> None:
        whole = sample_file()
        for content, says in ((whole[:200], "cut short"), (sample_file(version=7), "version 1"),
                              (whole.replace(b"\nend 2", b"\nend 5"), "its last line says 5"),
                              (b"clearway repair samples 2\n", "--net graphsage"),
                              (sample_file(last=9), "vehicles that do not exist")):
            (self.folder / "bad.samples").write_bytes(content)
            message = self.message_of(clearway.InputError, lambda: clearway.dataset(self.folder))
            self.assertIn("bad.samples", message)
            self.assertIn(says, message)

    def test_damaged_lines_are_told(self) -> None:
        whole = sealed(b'clearway graph samples 1\n{"feature_count":8}\n', 0)
        for content in (*(sealed(b"clearway graph samples 1\n" + header + b"\n", 0) for header in (b"{x", b"{}", b"[]", b'{"feature_count":-3}')),
                        whole.replace(b"end 0", b"end x")):
            (self.folder / "x.samples").write_bytes(content)
            self.assertIn("is damaged", self.message_of(clearway.InputError, lambda: clearway.dataset(self.folder)))

    def test_the_hash_is_that_of_the_programs(self) -> None:
        self.assertEqual(content_hash([]), "99aa06d3014798d86001c324468d497f")  # of xxHash's own tests; results_test has files of the programs
        self.assertEqual(content_hash([b"clearway ", b"", b"graph"]), content_hash([b"clearway graph"]))

    def test_without_the_library_of_the_hash_nothing_is_taken_for_whole(self) -> None:
        (self.folder / "a.samples").write_bytes(sample_file())
        _xxhash.cache_clear()
        with mock.patch("ctypes.CDLL", side_effect=OSError("no such file")):
            self.assertIn("(Debian: libxxhash0)", self.message_of(clearway.EnvironmentFault, lambda: clearway.dataset(self.folder)))

    def test_a_flipped_bit_is_refused(self) -> None:
        whole = sample_file()
        for at in (40, 200, 230, len(whole) - 10):
            changed = bytearray(whole)
            changed[at] ^= 1
            (self.folder / "bad.samples").write_bytes(changed)
            self.assertRegex(self.message_of(clearway.InputError, lambda: clearway.dataset(self.folder)),
                             r"bad\.samples: its content hash is [0-9a-f]{32}, but its last line says .*\. It was changed or damaged\. Record")

    def test_what_is_no_file_is_refused_and_not_waited_for(self) -> None:
        os.mkfifo("x.samples")
        self.assertIn("x.samples: is not a regular file", self.message_of(clearway.InputError, lambda: clearway.dataset(self.folder)))
        os.remove("x.samples")
        os.mkdir("x.samples")
        self.assertIn("x.samples: cannot be read: Is a directory", self.message_of(clearway.InputError, lambda: clearway.dataset(self.folder)))
        os.rmdir("x.samples")
        for name in PUBLISHED:
            self.write_published()
            os.remove(name)
            os.mkfifo(name)
            self.assertIn(f"{name}: is not a regular file", self.message_of(clearway.InputError, lambda: clearway.dataset(self.folder)))
            os.remove(name)

    def test_a_folder_that_cannot_be_listed_is_told(self) -> None:
        (self.folder / "a.samples").write_bytes(sample_file())
        (self.folder / "sub").mkdir()
        (self.folder / "sub" / "b.samples").write_bytes(sample_file())
        (self.folder / "link").symlink_to("sub")  # not followed
        self.assertEqual(len(clearway.dataset(self.folder)), 4)
        listing = os.scandir

        def refuse(place: str) -> object:
            if os.path.basename(place) == "sub":
                raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), place)
            return listing(place)
        with mock.patch("os.scandir", refuse):
            self.assertIn("/sub: cannot be read: Permission denied", self.message_of(clearway.InputError, lambda: clearway.dataset(self.folder)))

    def test_no_file_is_blamed_for_the_machine(self) -> None:
        (self.folder / "many").mkdir()
        (self.folder / "many" / "a.samples").write_bytes(sample_file())
        (self.folder / "one").mkdir()
        os.chdir("one")
        self.write_published()
        for call, place in (*(("read", f"one/{name}") for name in PUBLISHED), ("read", "many/a.samples"), ("getdents64", "many")):
            said = told_when(call, "EIO", self.folder / place, f"clearway.dataset({str(self.folder / place.partition('/')[0])!r})")
            self.assertRegex(said, rf"^EnvironmentFault: .*/{place}: cannot be read: Input/output error\. .*: give the same call again$")

    def test_names_that_no_path_has_are_refused(self) -> None:
        for folder in ("\0", "a\0b", None, 3):
            self.assertIn(f"folder is {folder!r} (allowed: a path", self.message_of(clearway.InputError, lambda: clearway.dataset(folder)))

    def test_other_folders_are_refused(self) -> None:
        self.assertIn("holds neither", self.message_of(clearway.InputError, lambda: clearway.dataset(self.folder)))
        self.write("edge_list.csv", "0,1\n2,5\n")
        self.write("vehicle_features.csv", "1,2\n3,4\n")
        self.write("target_y.csv", "1,0\n")
        self.assertIn("do not fit", self.message_of(clearway.InputError, lambda: clearway.dataset(self.folder)))
        self.write("target_y.csv", "1,x\n")
        self.assertIn("target_y.csv", self.message_of(clearway.InputError, lambda: clearway.dataset(self.folder)))


if __name__ == "__main__":
    unittest.main()
