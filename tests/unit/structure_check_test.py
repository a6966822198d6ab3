#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/check-structure must fire: one small tree a rule, with one violation, and the rule's name and place expected."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CHECKER = Path(__file__).resolve().parents[2] / "tools" / "check-structure"
HEAD = "// SPDX-License-Identifier: Apache-2.0\n// A test's source.\n"


def check(files):
    """Exit status and output of the checker over a tree of these files."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text.replace("@ROOT@", str(root.resolve())))
        result = subprocess.run([sys.executable, CHECKER, folder], capture_output=True, text=True, check=False)
        return result.returncode, result.stdout + result.stderr


def function_of(lines):
    return "int f() {\n" + "  g();\n" * (lines - 2) + "}\n"


# Name of the case: (file, its text, rule, line).
ONE_FILE = {
    "no licence": ("rt/a.cpp", "int f();\n", "spdx", 1),
    "no purpose": ("rt/a.cpp", HEAD.splitlines()[0] + "\nint f();\n", "purpose", 2),
    "no pragma once": ("rt/a.hpp", HEAD + "int f();\n", "pragma-once", 1),
    "rt includes drivers": ("rt/a.cpp", HEAD + '#include "drivers/a.hpp"\n', "arrow", 3),
    "drivers include mapping": ("drivers/x/a.cpp", HEAD + '#include "mapping/a.hpp"\n', "arrow", 3),
    "mapping includes estimator": ("mapping/a.cpp", HEAD + '#include "estimator/a.hpp"\n', "arrow", 3),
    "estimator includes backend": ("estimator/a.cpp", HEAD + '#include "backend/a.hpp"\n', "arrow", 3),
    "backend includes estimator": ("backend/a.cpp", HEAD + '#include "estimator/a.hpp"\n', "arrow", 3),
    "board includes tools": ("board/a.cpp", HEAD + '#include "tools/a.hpp"\n', "arrow", 3),
    "tools include tests": ("tools/a.cc", HEAD + '#include "tests/a.hpp"\n', "arrow", 3),
    "path without room": ("rt/a.cpp", HEAD + '#include "a.hpp"\n', "include-path", 3),
    "word": ("board/a.cpp", HEAD + "// TO" + "DO: later\n", "left-undone", 3),
    "suppression without reason": ("board/a.cpp", HEAD + "int f();  // NOLINT(some-check)\n", "nolint", 3),
    "suppression without check": ("board/a.cpp", HEAD + "int f();  // NOLINT: because\n", "nolint", 3),
    "using namespace std": ("board/a.cpp", HEAD + "using namespace std;\n", "using-namespace-std", 3),
    "using namespace in a header": ("board/a.hpp", HEAD + "#pragma once\nusing namespace x;\n", "using-namespace-in-header", 4),
    "exit in the product": ("board/a.cpp", HEAD + "void f() { std::exit(1); }\n", "exit", 3),
    "hypot": ("drivers/x/a.cpp", HEAD + "double f(double x) { return std::hypot(x, x); }\n", "hypot", 3),
    "global": ("board/a.cpp", HEAD + "int counter = 0;\n", "mutable-global", 3),
    "machine path": ("board/a.cpp", HEAD + "// see @ROOT@/notes\n", "machine-path", 3),
    "long file": ("board/a.cpp", HEAD + "\n" * 299, "file-length", 1),
    "long function": ("board/a.cpp", HEAD + function_of(61), "function-length", 3),
    "raw new": ("rt/a.cpp", HEAD + "int* f() { return new int; }\n", "allocation", 3),
    "malloc": ("mapping/a.cpp", HEAD + "void* f() { return std::malloc(4); }\n", "allocation", 3),
    "make_unique": ("estimator/a.cpp", HEAD + "auto f() { return std::make_unique<int>(); }\n", "allocation", 3),
    "push_back": ("estimator/a.cpp", HEAD + "void f(V& v) { v.push_back(1); }\n", "growing-container", 3),
    "string": ("mapping/a.cpp", HEAD + "std::string f();\n", "string", 3),
    "std::function": ("rt/a.cpp", HEAD + "void f(std::function<void()> g);\n", "function-object", 3),
    "mutex": ("rt/a.cpp", HEAD + "void f(std::mutex& m);\n", "lock", 3),
    "thread": ("mapping/a.cpp", HEAD + "void f() { std::jthread t(g); }\n", "thread", 3),
    "throw": ("estimator/a.cpp", HEAD + "void f() { throw 1; }\n", "throw", 3),
    "print": ("estimator/a.cpp", HEAD + 'void f() { std::printf("x"); }\n', "output", 3),
    "iostream": ("rt/a.cpp", HEAD + "#include <iostream>\n", "real-time-header", 3),
}

SOUND = {
    "rt/a.hpp": HEAD + "#pragma once\n#include <new>\ninline constexpr int kLimit = 3;  // never std::string or new, says this\n",
    "rt/a.cpp": HEAD.splitlines()[0] + '\n#include "rt/a.hpp"\nT* f(void* p) { return new (p) T("malloc("); }\n',
    "board/a.cpp": HEAD + '#include "estimator/a.hpp"\nstd::string f(); // NOLINT(some-check): a reason\n',
    "tests/unit/a_test.cpp": HEAD + "TEST(A, B) { std::exit(0); }\n",
}


class StructureCheck(unittest.TestCase):
    def test_every_rule_fires_at_its_place(self):
        for name, (path, text, rule, line) in ONE_FILE.items():
            with self.subTest(name):
                status, output = check({path: text})
                self.assertEqual(status, 1, output)
                self.assertIn(f"{path}:{line}: {rule}: ", output)
                self.assertEqual(output.count(f"{path}:"), 1, output)  # and no other rule does

    def test_sound_tree_passes(self):
        status, output = check(SOUND)
        self.assertEqual(status, 0, output)

    def test_figures_fire(self):
        cases = {
            "file median": {f"board/{i}.cpp": HEAD + "\n" * 130 for i in range(3)},
            "function median": {"board/a.cpp": HEAD + function_of(7) * 3},
            "function p90": {"board/a.cpp": HEAD + function_of(3) * 8 + function_of(26) * 2},
            "function p99": {"board/a.cpp": HEAD + function_of(3) * 8 + function_of(61)},
        }
        for figure, files in cases.items():
            with self.subTest(figure):
                status, output = check(files)
                self.assertEqual(status, 1, output)
                self.assertIn(f"figure: {figure} is ", output)

    def test_two_types_of_one_name_fire_wherever_both_could_be_linked(self):
        def tree(second):
            return {"rt/a.hpp": HEAD + "#pragma once\nnamespace x {\nstruct Sight { int a; };\n}\n", "rt/b.hpp": HEAD + "#pragma once\n" + second}
        status, output = check(tree("namespace x {\nclass Sight { double b; };\n}\n"))
        self.assertEqual(status, 1, output)
        self.assertIn("rt/b.hpp:5: type-twice: Sight, also in rt/a.hpp", output)
        for elsewhere in ("namespace y {\nstruct Sight { double b; };\n}\n", "namespace x {\nnamespace {\nstruct Sight { double b; };\n}\n}\n",
                          "namespace x {\nstruct Sight;\n}\n"):
            status, output = check(tree(elsewhere))
            self.assertEqual(status, 0, output)

    def test_exception_with_a_reason_excuses_its_rule_only(self):
        source = {"rt/a.cpp": HEAD + "std::string f();\nvoid g() { throw 1; }\n"}
        status, output = check(source | {"tools/check-structure.exceptions": "rt/a.cpp string start-up only\n"})
        self.assertEqual(status, 1, output)
        self.assertNotIn("string", output)
        self.assertIn("rt/a.cpp:4: throw: ", output)

    def test_exceptions_must_have_a_reason_and_a_use(self):
        _, output = check(SOUND | {"tools/check-structure.exceptions": "rt/a.cpp string\n"})
        self.assertIn("check-structure.exceptions:1: exception: ", output)
        status, output = check(SOUND | {"tools/check-structure.exceptions": "rt/a.cpp string start-up only\n"})
        self.assertEqual(status, 1)
        self.assertIn("rt/a.cpp:0: stale-exception: ", output)


if __name__ == "__main__":
    unittest.main()
