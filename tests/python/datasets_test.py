"""Data sets as edge lists: files written by hand, byte by byte, against what is read."""
import json
import struct
import unittest

import clearway
import numpy as np
from support import FolderCase

ORIGIN = {"scenario": "s", "failure": "B10", "feature_name": "corrected", "feature_version": 2, "feature_count": 2,
          "study_seed": 1, "replication": 3, "link_radius_m": 50.0}


def sample_file(samples: int = 2, version: int = 1) -> bytes:
    content = b"clearway graph samples %d\n" % version + json.dumps(ORIGIN).encode() + b"\n"
    for number in range(samples):
        content += struct.pack("<dIII", 10.0 + number, 3, 1, 2)
        content += struct.pack("<6f", 1, 2, 3, 4, 5, 6) + struct.pack("<2I", 0, 2)
        content += struct.pack("<IIfB", 0, 1, 40.0, 1) + struct.pack("<IIfB", 1, 2, 70.0, 0)
    return content + b"\nend %d %s\n" % (samples, b"0" * 32)


class DatasetTest(FolderCase):
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
        self.write("edge_list.csv", "0,1\n2,2\n")
        self.write("vehicle_features.csv", "1.5,2\n3,4\n5,6\n")
        self.write("target_y.csv", "1,0\n")
        (only,) = clearway.dataset(self.folder)
        np.testing.assert_array_equal(only.edge_label_index, [[0, 1], [2, 2]])
        np.testing.assert_array_equal(only.edge_index, [[0, 1, 2, 2], [2, 2, 0, 1]])
        np.testing.assert_array_equal(only.x, [[1.5, 2], [3, 4], [5, 6]])

    def test_bad_files_are_named(self) -> None:
        whole = sample_file()
        for content, says in ((whole[:200], "cut short"), (sample_file(version=7), "version 1"),
                              (whole.replace(b"\nend 2", b"\nend 5"), "its last line says 5"),
                              (b"clearway repair samples 2\n", "--net graphsage"),
                              (whole.replace(struct.pack("<IIfB", 1, 2, 70.0, 0), struct.pack("<IIfB", 1, 9, 70.0, 0)),
                               "vehicles that do not exist")):
            (self.folder / "bad.samples").write_bytes(content)
            message = self.message_of(clearway.InputError, lambda: clearway.dataset(self.folder))
            self.assertIn("bad.samples", message)
            self.assertIn(says, message)

    def test_damaged_lines_are_told(self) -> None:
        for header, last in ((b"{x", b"end 0 0"), (b"{}", b"end 0 0"), (b"[]", b"end 0 0"), (b'{"feature_count":-3}', b"end 0 0"),
                             (b'{"feature_count":8}', b"end x 0")):
            (self.folder / "x.samples").write_bytes(b"clearway graph samples 1\n" + header + b"\n\n" + last + b"\n")
            self.assertIn("is damaged", self.message_of(clearway.InputError, lambda: clearway.dataset(self.folder)))

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
