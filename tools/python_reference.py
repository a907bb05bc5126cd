#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/python-api.md, the reference of the Python package, from its stub and its Python files.

Usage: tools/python_reference.py STUB [--out docs/python-api.md] [--check]
STUB is build/release/python/ovimap/_ovimap.pyi. With --check the page is compared, not written.
"""
import argparse
import ast
import inspect
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "python" / "ovimap"
HEAD = """# Python reference

Made from the package by `tools/python_reference.py`; docs/python.md is the introduction. `help(ovimap.Mapper)` says the
same. Everything here is imported from `ovimap` unless a heading names another module.
"""


def public(nodes):
    kinds = (ast.ClassDef, ast.FunctionDef)
    return [node for node in nodes if isinstance(node, kinds) and (not node.name.startswith("_") or node.name == "__init__")]



class PlainTypes(ast.NodeTransformer):
    """Arrays without their machine-readable shapes, which the text says in words, and floats without float32's last digits."""

    def visit_Subscript(self, node):
        self.generic_visit(node)
        return node.slice.elts[0] if isinstance(node.value, ast.Name) and node.value.id == "Annotated" else node

    def visit_Constant(self, node):
        return ast.Name(f"{node.value:.6g}") if isinstance(node.value, float) and node.value % 1 else node


def is_property(node):
    return any(isinstance(mark, ast.Name) and mark.id == "property" for mark in node.decorator_list)


def signature(node):
    arguments = node.args
    for group in (arguments.posonlyargs, arguments.args):
        group[:] = [argument for argument in group if argument.arg != "self"]
    if is_property(node):
        return f"{node.name}: {ast.unparse(node.returns)}"
    result = "" if node.returns is None or node.name == "__init__" else f" -> {ast.unparse(node.returns)}"
    return f"({ast.unparse(arguments)})" if node.name == "__init__" else f"{node.name}({ast.unparse(arguments)}){result}"


def function_lines(node, head):
    return [f"{head} `{signature(node)}`", "", *described(node)]


def described(node):
    text = inspect.cleandoc(ast.get_docstring(node) or "")
    if "\n" in text:
        return ["```text", *text.splitlines(), "```", ""]
    return [text, ""] if text else []


def member_lines(node):
    """One line a member where its text is one, in a list."""
    text = " ".join((ast.get_docstring(node) or "").split())
    return [f"- `{signature(node)}`" + (f": {text}" if text else "")]


def class_lines(node):
    bases = ", ".join(ast.unparse(base) for base in node.bases)
    lines = [f"### {node.name}" + (f" ({bases})" if bases else ""), "", *described(node)]
    for member in public(node.body):
        if member.name == "__init__":
            lines += [f"    {node.name}{signature(member)}", ""]
    members = [line for member in public(node.body) if member.name != "__init__" for line in member_lines(member)]
    return [*lines, *members, *([""] if members else [])]


def taken_from_bindings():
    """What the package gives out of its bindings; the rest is for its own files."""
    tree = ast.parse((PACKAGE / "__init__.py").read_text())
    return {name.name for node in tree.body if isinstance(node, ast.ImportFrom) and node.module == "_ovimap" for name in node.names}


def module_lines(title, path, chosen=None):
    tree = PlainTypes().visit(ast.parse(path.read_text()))
    nodes = [node for node in public(tree.body) if chosen is None or node.name in chosen]
    lines = [f"## {title}", ""]
    if path.suffix == ".py":
        lines += [*described(tree)]
    for node in nodes:
        lines += class_lines(node) if isinstance(node, ast.ClassDef) else function_lines(node, "###")
    return lines if nodes else []


def page(stub):
    lines = [HEAD]
    lines += module_lines("Maps, mappers, frames", stub, taken_from_bindings())
    lines += module_lines("Whole commands", PACKAGE / "commands.py")
    for path in sorted(PACKAGE.glob("*.py")):
        if path.stem not in ("__init__", "commands"):
            lines += module_lines(f"ovimap.{path.stem}", path)
    return "\n".join(lines).rstrip() + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("stub", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs" / "python-api.md")
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    text = page(arguments.stub)
    if not arguments.check:
        arguments.out.write_text(text)
    elif not arguments.out.exists() or arguments.out.read_text() != text:
        sys.exit(f"{arguments.out} is not what the package says; run: tools/python_reference.py {arguments.stub}")


if __name__ == "__main__":
    main()
