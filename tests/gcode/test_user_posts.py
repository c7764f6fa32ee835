"""Posts of the user: files in the folder `posts` of the settings folder, whole ones and ones that extend another."""

from __future__ import annotations

import os
import re
from dataclasses import fields, is_dataclass
from pathlib import Path

import pytest

from app.core.errors import InputError
from app.core.resources import resource
from app.core.settings import config_folder
from app.gcode.checks.check import CheckReference, check
from app.gcode.posts import Post, load_post, post_names, post_titles
from app.gcode.writer.write import write_files
from tests.gcode.programs import job, two_tools

LINUXCNC = resource("posts", "linuxcnc.toml").read_text("utf-8")
OWN = ("fanuc", "grbl", "haas", "linuxcnc", "mach3")


def user_post(name: str, text: str) -> Path:
    folder = config_folder() / "posts"
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.toml"
    path.write_text(text, "utf-8")
    return path


def test_a_whole_post_of_the_user() -> None:
    user_post("router", LINUXCNC.replace('title = "LinuxCNC"', 'title = "My router"'))
    assert post_names() == (*OWN, "router")
    assert load_post("router").title == post_titles()["router"] == "My router"
    assert load_post("linuxcnc").title == "LinuxCNC"


def test_the_users_post_stands_before_the_programs_own() -> None:
    user_post("linuxcnc", LINUXCNC.replace("dwell_s = 2.0", "dwell_s = 7"))
    assert load_post("linuxcnc").spindle.dwell_s == 7
    assert post_names() == OWN


def test_a_post_may_say_only_what_differs() -> None:
    user_post("router", 'extends = "linuxcnc"\ntitle = "My router"\n[coolant]\nuse = "mist"\n[decimals.mm]\nF = 0\n')
    router, base = load_post("router"), load_post("linuxcnc")
    assert (router.title, router.coolant.use.value, router.decimals.mm.F) == ("My router", "mist", 0)
    assert (router.coolant.mist, router.decimals.mm.X, router.program) == (base.coolant.mist, 4, base.program)


def test_a_post_named_like_the_one_it_extends_means_the_programs_own() -> None:
    user_post("haas", 'extends = "haas"\nextension = ".eia"\n')
    user_post("shop", 'extends = "haas"\ntitle = "Shop"\n')
    assert load_post("haas").extension == ".eia" and load_post("haas").title == "Haas"
    assert load_post("shop").extension == ".eia", "the user's own haas is what others extend"


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (
            'extends = "nowhere"\n',
            "broken.toml: extends is 'nowhere'; expected is the name of another post: broken, fanuc, grbl",
        ),
        ("extends = 3\n", "broken.toml: extends is 3; expected is the name of another post"),
        ('extends = "broken"\n', "broken.toml: extends is 'broken'; expected is the name of another post"),
        (
            'extends = "linuxcnc"\n[spindle]\ndwell_s = -1\n',
            "broken.toml:3: spindle.dwell_s is -1; expected is a number from 0 to 600",
        ),
        ('extends = "linuxcnc"\nspindle = 3\n', "broken.toml:2: spindle is 3; expected is a table with dwell_s"),
        (
            'extends = "linuxcnc"\n[program]\nend = ["M2 {toll}"]\n',
            "broken.toml: program.end: {toll} in 'M2 {toll}' is not known",
        ),
        ('title = "half"\n', "broken.toml:1: extension is missing; add a text"),
        ("title = ", "broken.toml: this is no TOML file"),
        ("a = " + "[" * 5000, "broken.toml: this is no TOML file"),
    ],
)
def test_a_damaged_post_tells_why_and_leaves_the_others_alone(text: str, sentence: str) -> None:
    user_post("broken", text)
    with pytest.raises(InputError) as error:
        load_post("broken")
    assert str(error.value).startswith(sentence)
    assert post_titles()["broken"] == "broken (cannot be used)" and post_titles()["grbl"] == "grbl"
    assert load_post("linuxcnc").title == "LinuxCNC"


def test_posts_that_extend_each_other_in_a_ring() -> None:
    user_post("one", 'extends = "two"\n')
    user_post("two", 'extends = "one"\n')
    with pytest.raises(InputError, match=r"two.toml: extends is 'one'; expected is the name of another post"):
        load_post("one")


def test_a_file_that_is_no_text() -> None:
    (config_folder() / "posts" / "folder.toml").mkdir(parents=True)
    user_post("latin", "").write_bytes(b'title = "\xe9"')
    with pytest.raises(InputError, match=r"folder.toml cannot be read"):
        load_post("folder")
    with pytest.raises(InputError, match=r"latin.toml: this is no TOML file"):
        load_post("latin")


def test_names_with_paths_in_them_are_no_posts() -> None:
    user_post("router", LINUXCNC)
    for name in ("../posts/router", os.fspath(config_folder() / "posts" / "router"), "", "."):
        with pytest.raises(InputError, match="There is no post"):
            load_post(name)


def test_the_manuals_examples_are_posts_whose_programs_read_back() -> None:
    examples = re.findall(r"```toml\n(.*?)```", resource("docs", "posts.md").read_text("utf-8"), re.S)
    assert len(examples) == 2
    for number, text in enumerate(examples):
        user_post(f"example{number}", text)
        post, program = load_post(f"example{number}"), two_tools().program()
        (file,) = write_files(program, job(), post)
        assert check(file.nc.text.encode("ascii"), file, CheckReference(program, job(), post)).problems == ()
    assert "N50 T01 M6\nN60 G0 G43 H01 Z5.\nN70 S12000 M3\nN80 T2\nN90 G4 P2000\n" in file.nc.text


def test_a_title_may_have_any_letters() -> None:
    user_post("router", 'extends = "fanuc"\ntitle = "Fräse (groß); 歯車"\n')
    (file,) = write_files(two_tools().program(), job(), load_post("router"))
    assert file.nc.text.isascii() and "(HITOFUDE FOR FRASE _GRO___ __, LENGTHS IN MM)" in file.nc.text


def test_the_manual_names_every_table_and_key() -> None:
    manual = resource("docs", "posts.md").read_text("utf-8")
    for table in fields(Post):
        assert f"`{table.name}" in manual
        inside = (
            fields(getattr(load_post("linuxcnc"), table.name))
            if is_dataclass(getattr(load_post("linuxcnc"), table.name))
            else ()
        )
        if table.name not in ("decimals", "drilling"):
            assert [key.name for key in inside if f"`{key.name}`" not in manual] == []
