"""same_bytes.py GROUP A B [A B]...: the datasets in this group of HDF5 files have the same bytes in A as in B, pair by pair.
GROUP may be one dataset.
Counts of written files are ignored. Prints a line for each dataset that differs or is missing in one file, and ends with
1."""

import sys

import h5py

COUNTS = {"checkpoints_written", "snapshots_written", "last_snapshot_step"}


def differences(group, a, b):
    with h5py.File(a) as first, h5py.File(b) as second:
        if isinstance(first[group], h5py.Dataset):
            group, name = group.rsplit("/", 1)
            names = {name}
        else:
            names = first[group].keys() | second[group].keys()
        first, second = first[group], second[group]
        if not names:
            yield f"nothing in {group} of {a}"
        for name in sorted(names - COUNTS):
            if name not in first or name not in second:
                yield f"{group}/{name} is in one of {a} and {b} alone"
            elif (first[name].dtype, first[name].shape) != (second[name].dtype, second[name].shape):
                yield f"{group}/{name} has another type or shape in {b}"
            elif first[name][()].tobytes() != second[name][()].tobytes():
                yield f"{group}/{name} differs in {b}"


def main(group, *files):
    found = [line for a, b in zip(files[::2], files[1::2]) for line in differences(group, a, b)]
    print("\n".join(found))
    return 1 if found else 0


sys.exit(main(*sys.argv[1:]))
