"""What the tests of checkpoints share: scenes, comparisons to the last bit, runs that go on."""
import glob
import os
import shutil
import subprocess

import h5py
import numpy as np

from harness import FOLDER, PROGRAM, ROOT, check, geometry, histories, ledger, options, run, small_block


def scene(file, **changes):
    """A shipped scene with some options changed, its mesh made."""
    settings = {**options(file), **{"-" + name: value for name, value in changes.items()}}
    mesh = os.path.splitext(os.path.basename(settings["-mesh"]))[0]
    built = os.path.join(ROOT, settings["-mesh"])
    if "mesh" not in changes and not os.path.exists(built):
        settings["-mesh"] = small_block() if mesh == "small_block" else geometry(mesh)
    settings.setdefault("-tissue_element", "auto")  # as shipped
    settings.pop("-checkpoint_every", None)
    return settings


def fields(folder):
    """All numbers of all field files, by file and name."""
    found = {}
    for path in sorted(glob.glob(folder + "/fields/*.h5")):
        with h5py.File(path) as file:
            file.visititems(lambda name, node, path=path: found.__setitem__(
                os.path.basename(path) + ":" + name, node[...]) if isinstance(node, h5py.Dataset) else None)
    return found


def text(path):
    with open(path) as stream:
        return stream.read()


def differences(one, other):
    """What two folders do not share to the last bit; wall times apart."""
    found = []
    for read in (histories, fields):
        a, b = read(one), read(other)
        found += sorted(set(a) ^ set(b))
        found += [name for name in a if name in b and not np.array_equal(a[name], b[name])]
    if text(one + "/run.xdmf") != text(other + "/run.xdmf"):
        found.append("run.xdmf")
    if ledger(one) != ledger(other):
        found.append(f"ledger {ledger(one)} {ledger(other)}")
    return found


def copied(folder, name):
    to = os.path.join(FOLDER, name)
    shutil.copytree(folder, to)
    return to


def gone_on(settings, folder, ranks=1):
    process = run({**settings, "-restart": folder, "-output_dir": folder, "-quiet": ""}, ranks)
    check(process.returncode == 0, f"goes on: {process.stderr[-300:]}")


def deterministic(settings):
    return {**settings, **options("deterministic.opts")}


def started(settings, ranks=1):
    words = []
    for name, value in settings.items():
        words += [name] + ([value] if value else [])
    launcher = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    return subprocess.Popen([*launcher, PROGRAM, *words], cwd=ROOT, start_new_session=True, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE)
