# testStubs.py - the stubs name what the module has, and everything has a docstring.
# SPDX-License-Identifier: MIT
import ast
import inspect
import unittest
from pathlib import Path

import osgraytrace

STUBS = ast.parse((Path(osgraytrace.__file__).parent / "__init__.pyi").read_text())
OWN = {"__init__", "__getitem__", "__setitem__", "__contains__", "__len__", "__iter__"}
PICKLING = {"__getstate__", "__setstate__"}


def stubbed(node):
    """Returns the public names of a module or class of the stubs."""
    names = {child.name for child in node.body if isinstance(child, (ast.FunctionDef, ast.ClassDef))}
    names |= {child.target.id for child in node.body if isinstance(child, ast.AnnAssign)}
    return {name for name in names if not name.startswith("_") or name in OWN}


def present(owner):
    names = vars(owner) if inspect.isclass(owner) else owner.__all__
    return {name for name in names if not name.startswith("_") or name in OWN}


class StubsAreTrue(unittest.TestCase):
    def test_the_module_has_these_names(self):
        self.assertEqual(stubbed(STUBS), present(osgraytrace))

    def test_the_classes_have_these_members(self):
        for node in STUBS.body:
            if isinstance(node, ast.ClassDef) and not issubclass(getattr(osgraytrace, node.name),
                                                                 Exception):
                expected = present(getattr(osgraytrace, node.name))
                if node.name in ("PassSums", "Settings"):
                    expected -= {"__init__"}  # nobody makes them by hand
                self.assertEqual(stubbed(node), expected, node.name)

    def test_the_functions_have_these_arguments(self):
        for node in STUBS.body:
            if not isinstance(node, ast.ClassDef):
                continue
            for function in node.body:
                if not isinstance(function, ast.FunctionDef) or function.decorator_list:
                    continue
                arguments = function.args
                names = [argument.arg for argument in arguments.args if argument.arg != "self"]
                text = getattr(getattr(osgraytrace, node.name), function.name).__doc__
                if function.name in ("__len__", "__iter__") or not names:
                    continue
                signature = text.splitlines()[0].split(") ->")[0]
                for name, default in zip(reversed(names), reversed([None] * len(names) +
                                                                   list(arguments.defaults))):
                    self.assertIn(f"{name}:", signature, function.name)
                    if default is not None:
                        self.assertIn(f"= {ast.unparse(default)}".replace("(0.0, 0.0, 1.0)", "["),
                                      signature)

    def test_everything_is_described_and_typed(self):
        self.assertTrue((Path(osgraytrace.__file__).parent / "py.typed").exists())
        for name in osgraytrace.__all__:
            thing = getattr(osgraytrace, name)
            self.assertTrue(thing.__doc__, name)
            members = present(thing) if inspect.isclass(thing) else []
            for member in set(members) - OWN - {"channels"}:
                text = getattr(thing, member).__doc__ or ""
                described = [line for line in text.splitlines() if line and "->" not in line]
                self.assertTrue(described, f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
