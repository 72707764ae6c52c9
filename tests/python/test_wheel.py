"""The wheel of the in-tree backend, unpacked elsewhere, is a package that works without the tree."""
import os
import pathlib
import subprocess
import sys
import zipfile

import pliant
from conftest import SOURCE


def test_the_wheel_works_outside_of_the_tree(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(SOURCE / "python"))
    import pliant_build

    build = pathlib.Path(pliant.__file__).absolute().parents[2]
    name = pliant_build.build_wheel(str(tmp_path), {"build": str(build)})
    with zipfile.ZipFile(tmp_path / name) as wheel:
        wheel.extractall(tmp_path / "there")
        names = wheel.namelist()
    record = (tmp_path / "there/pliant-0.1.0.dist-info/RECORD").read_text().splitlines()
    assert sorted(line.split(",")[0] for line in record) == sorted(names)
    code = ("import pliant as pl; s = pl.Session('minimal'); s.tick(0, 0.001, 0)\n"
            "print(pl.__file__, len(pl.levels()), s.tick(0, -0.001, 0)[1])")
    environment = {k: v for k, v in os.environ.items() if k not in ("PLIANT", "PYTHONPATH")}
    ran = subprocess.run([sys.executable, "-c", code], cwd=tmp_path / "there", env=environment, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    file, levels, force = ran.stdout.split()
    assert file.startswith(str(tmp_path)) and int(levels) >= 10 and float(force) == 0.3
