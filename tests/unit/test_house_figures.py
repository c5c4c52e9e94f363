"""Figures of a checkout count what they say."""

from pathlib import Path

from house_figures import public_names, python_lines, rust_lines


def test_docstrings_are_comments_and_examples_are_counted(tmp_path: Path) -> None:
    module = tmp_path / "module.py"
    text = '"""Say it.\n\n>>> 1\n1\n"""\n\n# Why.\nA = 1  # beside\n\n'
    module.write_text(text + '\ndef f():\n    """Do."""\n    return A\n')
    assert python_lines(module) == {"code": 3, "comments": 6, "examples": 1}


def test_tests_of_a_rust_file_are_counted_apart(tmp_path: Path) -> None:
    file = tmp_path / "one.rs"
    file.write_text(
        "//! One.\n//! ```\n//! f();\n//! ```\n//! ```text\n//! no code\n//! ```\n\nfn f() {}\n\n"
        "#[cfg(test)]\nmod tests {\n    #[test]\n    fn t() {}\n}\n"
    )
    assert rust_lines(file) == {"code": 1, "comments": 7, "tests": 4, "examples": 1}


def test_what_follows_the_name_of_a_file_of_tests_is_code(tmp_path: Path) -> None:
    file = tmp_path / "one.rs"
    file.write_text("//! One.\n\n#[cfg(test)]\nmod tests;\n\n/// Do.\nfn f() {}\n")
    assert rust_lines(file) == {"code": 3, "comments": 2, "tests": 0, "examples": 0}


def test_files_for_tests_alone_are_tests(tmp_path: Path) -> None:
    (tmp_path / "mod.rs").write_text("pub mod one;\n#[cfg(test)]\npub(crate) mod scenes;\n")
    for name in ("one.rs", "scenes.rs"):
        (tmp_path / name).write_text("fn f() {}\n")
    assert rust_lines(tmp_path / "one.rs")["tests"] == 0
    assert rust_lines(tmp_path / "scenes.rs") == {"tests": 1}


def test_names_of_classes_below_are_counted(tmp_path: Path) -> None:
    (tmp_path / "low.py").write_text(
        "class Low:\n    def low(self): ...\n    def _own(self): ...\n"
    )
    (tmp_path / "top.py").write_text("class Top(Low):\n    __slots__ = ()\n    both = 1\n")
    assert public_names(tmp_path, "Top") == {"low", "both"}
