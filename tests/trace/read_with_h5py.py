"""Prints the positions of a recording as `clearway replay --csv snapshot` does: time_s, vehicle, x_m, y_m; reads them with h5py alone."""
import csv
import sys

import h5py

with h5py.File(sys.argv[1]) as recording:
    ids = recording["vehicles/id"].asstr()[:]
    begin = recording["steps/snapshot_begin"][:]
    time_s = recording["steps/time_s"][:]
    vehicle, x_m, y_m = (recording[f"snapshot/{name}"][:] for name in ("vehicle", "x_m", "y_m"))
    assert recording["snapshot/x_m"].attrs["unit"] == b"m"
    assert h5py.check_enum_dtype(recording["snapshot/class"].dtype)["emergency"] == 2
    assert recording["observation/is_report"].dtype == bool
    lines = csv.writer(sys.stdout, lineterminator="\n")
    for step in range(len(time_s)):
        for row in range(begin[step], begin[step + 1]):
            lines.writerow((repr(float(time_s[step])), ids[vehicle[row]], repr(float(x_m[row])), repr(float(y_m[row]))))
