"""The files of the page of `pyfrc sim --ui web`: libraries as in their packages, nothing that a browser refuses."""

from __future__ import annotations

import base64
import hashlib
import json
import re

import pytest

from pyfrc_core.sim.ui.web.single_file import PAGE, data_url

pytestmark = pytest.mark.bare


def test_libraries_are_files_of_their_packages_with_licences() -> None:
    packages = json.loads((PAGE / "vendor/vendor.json").read_text("utf-8"))["packages"]
    listed = {file["file"]: file["sha256"] for package in packages for file in package["files"]}
    found = {
        file.relative_to(PAGE / "vendor").as_posix(): hashlib.sha256(file.read_bytes()).hexdigest()
        for file in (PAGE / "vendor").rglob("*")
        if file.is_file() and file.name != "vendor.json"
    }
    assert found == listed
    for package in packages:
        assert package["licence"] in ("MIT", "Apache-2.0", "OFL-1.1"), package
        assert any(file["in_package"] == "LICENSE" for file in package["files"]), package


def test_the_page_needs_no_network_no_build_and_makes_no_html_of_texts() -> None:
    files = [file for file in PAGE.rglob("*") if file.suffix in (".js", ".css", ".html") and "vendor" not in file.parts]
    assert len(files) > 20
    for file in files:
        text = file.read_text("utf-8")
        for wrong in (
            "innerHTML",
            "outerHTML",
            "insertAdjacentHTML",
            "dangerouslySetInnerHTML",
            "document.write",
            "eval(",
        ):
            assert wrong not in text, (file, wrong)
        assert not re.search(r"(?:src|href)=[\"'](?:https?:)?//", text), file
        assert len(text.splitlines()) < 1000, file
    index = (PAGE / "index.html").read_text("utf-8")
    assert "<style" not in index
    assert " style=" not in index
    (_, names), script = re.findall(r"<script(.*?)>(.*?)</script>", index)
    assert script == (' type="module" src="/static/js/main.js"', "")
    places = {name: place.removeprefix("/static/") for name, place in json.loads(names)["imports"].items()}
    # Each module imports files that exist, by names of the import map, and names that they export.
    for file in (PAGE / "js").rglob("*.js"):
        imports = re.findall(r'^(?:import|export)\b([^"]*?)from "([^"]+)"', file.read_text("utf-8"), re.MULTILINE)
        for names, name in imports:
            begin, slash, rest = name.partition("/")
            other = PAGE / (places[begin + slash] + rest)
            assert other.is_file(), (file, name)
            if "vendor" not in other.parts and "{" in names:
                for each in re.findall(r"\w+", names):
                    exported = rf"^export (?:async )?(?:function\*?|class|const) {each}\b|^export \{{.*\b{each}\b"
                    assert re.search(exported, other.read_text("utf-8"), re.MULTILINE), (file, name, each)


def test_a_file_becomes_an_address_of_its_kind(tmp_path) -> None:
    picture = b"\x89PNG\r\n\x1a\n"
    for name, content, kind in (("field.png", picture, "image/png"), ("main.js", b"abc", "text/javascript")):
        (tmp_path / name).write_bytes(content)
        assert data_url(tmp_path / name) == f"data:{kind};base64,{base64.b64encode(content).decode()}"
