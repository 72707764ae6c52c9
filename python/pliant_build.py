"""Builds the wheel (PEP 517) from this tree: CMake for the compiled module, zipfile for the rest; nothing is downloaded.

Settings of pip: --config-settings build=FOLDER uses that build tree, as build/release, which a developer has; jobs=N. The
default is build/wheel, configured for the module alone.
"""
from __future__ import annotations

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SUFFIX = sysconfig.get_config_var("EXT_SUFFIX")


def _version() -> str:
    found = re.search(r"project\(pliant VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
    assert found
    return found[1]


def _metadata() -> str:
    return (f"Metadata-Version: 2.1\nName: pliant\nVersion: {_version()}\n"
            "Summary: Visuo-haptic engine: touch soft things, feel the force at 1 kHz\n"
            "Requires-Python: >=3.9\nRequires-Dist: numpy>=1.21\n")


def _tag() -> str:
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{re.sub('[^a-z0-9_]', '_', sysconfig.get_platform().lower())}"


def _cmake(*arguments: object) -> None:
    try:
        done = subprocess.run(["cmake", *map(str, arguments)], cwd=ROOT)
    except FileNotFoundError:
        raise SystemExit("pliant: error: CMake is not installed; see the packages in ./dev") from None
    if done.returncode:
        raise SystemExit(f"pliant: error: cmake {arguments[0]} failed, see above; ./dev lists the packages that it needs")


def _module(settings: dict[str, str]) -> Path:
    given = settings.get("build")
    folder = Path(given).resolve() if given else ROOT / "build/wheel"
    if not given:
        _cmake("-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON",
               "-DCMAKE_UNITY_BUILD_BATCH_SIZE=24", "-DCMAKE_CXX_FLAGS_RELEASE=-O3 -DNDEBUG", "-DPLIANT_COMMAND=OFF",
               "-DPLIANT_INSTALL=OFF", "-DPLIANT_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}")
    elif not (folder / "CMakeCache.txt").is_file():
        raise SystemExit(f"pliant: error: {folder} is no build tree; configure it: cmake --preset release")
    _cmake("--build", folder, "--target", "pliant_python", "-j", settings.get("jobs", os.cpu_count() or 1))
    module = folder / "python/pliant" / f"_pliant{SUFFIX}"
    if not module.is_file():
        raise SystemExit(f"pliant: error: {folder} builds for another interpreter than {sys.executable} ({SUFFIX})")
    return module


def _modules(settings: dict[str, str]) -> list[Path]:
    module = _module(settings)
    window = module.with_name(f"_window{SUFFIX}")  # where GLFW is installed
    return [module, window] if window.is_file() else [module]


def _files() -> dict[str, Path]:
    package = ROOT / "python/pliant"
    files = {f"pliant/{f.name}": f for f in sorted(package.iterdir()) if f.suffix in (".py", ".pyi", ".typed")}
    for folder in ("levels", "environments"):
        for f in sorted((ROOT / "content" / folder).iterdir()):
            if f.is_file():
                files[f"pliant/content/{folder}/{f.name}"] = f
    return files


def _write(wheel: zipfile.ZipFile, records: list[str], name: str, data: bytes, mode: int = 0o644) -> None:
    info = zipfile.ZipInfo(name, (2020, 1, 1, 0, 0, 0))  # the same bytes from the same files
    info.compress_type, info.external_attr = zipfile.ZIP_DEFLATED, (0o100000 | mode) << 16
    wheel.writestr(info, data)
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    records.append(f"{name},sha256={digest},{len(data)}")


def build_wheel(wheel_directory: str, config_settings: dict[str, str] | None = None, metadata_directory: str | None = None) -> str:
    modules = _modules(config_settings or {})
    name, info = f"pliant-{_version()}-{_tag()}.whl", f"pliant-{_version()}.dist-info"
    records: list[str] = []
    with zipfile.ZipFile(Path(wheel_directory) / name, "w") as wheel:
        for to, file in _files().items():
            _write(wheel, records, to, file.read_bytes())
        for module in modules:
            stripped = module.with_suffix(".stripped")
            if subprocess.run(["strip", "--strip-unneeded", "-o", stripped, module]).returncode:
                stripped = module
            _write(wheel, records, f"pliant/{module.name}", stripped.read_bytes(), 0o755)
        _write(wheel, records, f"{info}/METADATA", _metadata().encode())
        _write(wheel, records, f"{info}/licenses/LICENSE", (ROOT / "LICENSE").read_bytes())
        _write(wheel, records, f"{info}/WHEEL", f"Wheel-Version: 1.0\nGenerator: pliant_build\nRoot-Is-Purelib: false\nTag: {_tag()}\n".encode())
        records.append(f"{info}/RECORD,,")
        wheel.writestr(zipfile.ZipInfo(f"{info}/RECORD", (2020, 1, 1, 0, 0, 0)), "\n".join(records) + "\n")
    return name


def build_sdist(sdist_directory: str, config_settings: dict[str, str] | None = None) -> str:
    name = f"pliant-{_version()}"
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout.decode().split("\0")
    with tarfile.open(Path(sdist_directory) / f"{name}.tar.gz", "w:gz", format=tarfile.PAX_FORMAT) as archive:
        for file in filter(None, listed):
            archive.add(ROOT / file, f"{name}/{file}")
        metadata = Path(sdist_directory) / "PKG-INFO"
        metadata.write_text(_metadata())
        archive.add(metadata, f"{name}/PKG-INFO")
        metadata.unlink()
    return f"{name}.tar.gz"
