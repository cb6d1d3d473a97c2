"""What the package is built of: the versions of the program, from one registry, under licences that are allowed."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

tomllib = pytest.importorskip("tomllib")

ALSO = {"BSD-2-Clause", "Apache-2.0 WITH LLVM-exception"}
"""Licences beside those of deny.toml: rust-numpy's, which is as permissive as MIT, and that of what PyO3 is built with."""


def locked(folder: Path) -> dict[str, set[str]]:
    packages: dict[str, set[str]] = {}
    for package in tomllib.loads((folder / "Cargo.lock").read_text())["package"]:
        packages.setdefault(package["name"], set()).add(package["version"])
        assert package.get("source", "registry+").startswith("registry+"), package
    return packages


def test_shared_libraries_have_the_versions_of_the_program(repository: Path) -> None:
    """Bytes can only agree where the same code computes."""
    theirs = locked(repository)
    for name, versions in locked(repository / "python").items():
        assert name not in theirs or versions <= theirs[name], name


def test_licences(repository: Path) -> None:
    if shutil.which("cargo") is None:
        pytest.skip("no cargo to ask")
    rules = tomllib.loads((repository / "deny.toml").read_text())
    allowed = ALSO | set(rules["licenses"]["allow"])
    call = ["cargo", "metadata", "--locked", "--offline", "--format-version", "1"]
    call += ["--filter-platform", "x86_64-unknown-linux-gnu"]
    done = subprocess.run(call, cwd=repository / "python", capture_output=True, text=True, check=True)
    packages: list[dict[str, Any]] = json.loads(done.stdout)["packages"]
    for package in packages:
        # Of all parts one alternative has to be allowed; older manifests write a slash.
        parts = package["license"].replace("(", "").replace(")", "").replace("/", " OR ").split(" AND ")
        assert all(set(part.strip().split(" OR ")) & allowed for part in parts), (package["name"], parts)
