#!/usr/bin/env python3
"""Renew the libraries of the browser page of ``pyfrc sim`` from their npm packages.

    .ci/renew_page_vendor.py                # fetch the versions in vendor.json again
    .ci/renew_page_vendor.py uplot@1.6.33   # fetch another version of one of them

Needs npm, which finds its registry itself. ``vendor.json`` lists each package with its version, its licence, and the
SHA-256 of each file, which are copied as they are in the package. The tests compare the files with that list.
"""

from __future__ import annotations

import hashlib
import json
import subprocess
import sys
import tarfile
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

VENDOR = Path(__file__).resolve().parents[1] / "pyfrc_core/sim/ui/web/page/vendor"


def fetch(package: str, into: Path) -> Path:
    """Download the tarball of a package, such as ``uplot@1.6.32``."""
    packed = subprocess.run(
        ["npm", "pack", "--silent", package], cwd=into, check=True, capture_output=True, text=True
    ).stdout.split()
    return into / packed[-1]


def renew(entry: dict[str, Any], version: str) -> None:
    """Replace the files of one package, and its entry in the list."""
    with (
        TemporaryDirectory() as directory,
        tarfile.open(fetch(f"{entry['name']}@{version}", Path(directory))) as tarball,
    ):

        def read(name: str) -> bytes:
            member = tarball.extractfile(f"package/{name}")
            assert member is not None, name
            return member.read()

        about = json.loads(read("package.json"))
        entry.update(version=about["version"], licence=about["license"])
        for file in entry["files"]:
            content = read(file["in_package"])
            target = VENDOR / file["file"]
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)
            file["sha256"] = hashlib.sha256(content).hexdigest()


def main(wanted: list[str]) -> None:
    """Renew all packages, or those in `wanted`, each as ``NAME@VERSION``."""
    vendor_list = VENDOR / "vendor.json"
    packages = json.loads(vendor_list.read_text("utf-8"))["packages"]
    versions = dict(each.rsplit("@", 1) for each in wanted)
    if unknown := versions.keys() - {entry["name"] for entry in packages}:
        sys.exit(f"not in vendor.json: {', '.join(sorted(unknown))}")
    for entry in packages:
        if not versions or entry["name"] in versions:
            renew(entry, versions.get(entry["name"], entry["version"]))
    vendor_list.write_text(json.dumps({"packages": packages}, indent=2) + "\n", "utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
