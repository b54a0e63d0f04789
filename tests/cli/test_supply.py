"""What others may put in the way: programs and packages that are fetched, and names of files that can be guessed."""

import pathlib
import re
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
LOCKS = ROOT / "tests" / "locks"


def sources(*kinds):
    """(name, text) of the files in git, or of all in a tree without git."""
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-co", "--exclude-standard"], capture_output=True, text=True)
    names = listed.stdout.splitlines() or [str(path.relative_to(ROOT)) for path in ROOT.rglob("*") if path.is_file()]
    for name in sorted(names):
        path = ROOT / name
        if (path.suffix in kinds or path.name in kinds) and path != pathlib.Path(__file__).resolve() and path.exists():
            yield name, path.read_text(encoding="utf-8")


class Supply(unittest.TestCase):
    def lines(self, pattern, *kinds):
        """(name, line) of the lines that have the pattern; continued lines are one. There must be some."""
        found = []
        for name, text in sources(*kinds):
            text = re.sub(r"\\\n\s*|(?<=,)\n\s*", " ", text)
            found += [(name, line.strip()) for line in text.splitlines() if re.search(pattern, line)]
        self.assertTrue(found, pattern)
        return found

    def test_actions_and_images_have_hashes(self):
        for name, line in self.lines(r"^\s*(- )?uses:", ".yml"):
            self.assertRegex(line, r"@[0-9a-f]{40} # v\d", name)
        for name, line in self.lines(r"^\s*(container:|- (debian|ubuntu)\b)", ".yml"):
            self.assertRegex(line, r"@sha256:[0-9a-f]{64}$|\$\{\{ matrix\.system \}\}$", name)

    def test_packages_have_hashes(self):
        for name, line in self.lines(r"\bpip\"?,?.*\b(install|download)\b", ".sh", ".py", "Makefile", "run"):
            if "pip install" in line and not name.endswith(".sh"):
                continue  # words for a reader
            self.assertRegex(line, r"--require-hashes|--no-deps\", wheel\]", name)
        for name, line in self.lines(r"\bnpm\b.*\b(install|ci|update)\b", ".sh", ".py", "Makefile", "run"):
            self.assertRegex(line, r"npm (ci|update --package-lock-only) .*--ignore-scripts", name)

    def test_locks_have_all_hashes(self):
        locks, included = sorted(LOCKS.rglob("*.txt")), set()
        self.assertTrue(locks)
        for lock in locks:
            text = lock.read_text()
            self.assertNotRegex(text, r"://|^-(?!r shared/[\w.-]+\n)", lock.name)
            needed = re.split(r"\n(?=\S)", text.rstrip().split("\n", 1)[1])
            included |= {package[3:] for package in needed if package.startswith("-r ")}
            for package in needed:
                if package.startswith("-r "):
                    continue
                self.assertRegex(package, r"^[\w.-]+==\S+[^\n]*\\\n    --hash=sha256:[0-9a-f]{64}", lock.name)
        self.assertEqual(included, {f"shared/{lock.name}" for lock in locks if lock.parent != LOCKS})
        for name, packages in sources("package-lock.json"):
            self.assertNotIn('"resolved"', packages, name)
            self.assertEqual(packages.count('"node_modules/'), packages.count('"integrity": "sha512-'), name)

    def test_packages_of_the_system_are_signed(self):
        for name, line in self.lines(r'\bdebootstrap"?,? ', ".sh", ".py"):
            if "run(" in line:
                self.assertIn("--force-check-gpg", line, name)
        for name, text in sources(".sh", ".py", ".yml", "Makefile", "Dockerfile"):
            self.assertNotRegex(text, r"--allow-unauthenticated|trusted=yes|--no-check-gpg|\b(curl|wget) -", name)

    def test_no_name_of_a_file_can_be_guessed(self):
        """In folders that all may write to. .tmp beside a file of the user's has a random number, see file.c."""
        for name, text in sources(".c", ".h", ".py", ".sh"):
            for line in text.splitlines():
                self.assertNotRegex(line, r'"[^"]*(/tmp|/shm|singe-)[^"]*%l?[du]|getpid\(\)\}|\b(tmpnam|tempnam|mktemp)\(',
                                    name)
