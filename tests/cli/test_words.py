"""The command's words: examples of the help, the manual, completion in real shells, and what a mistyped word brings."""

import os
import re
import shlex
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from support import SINGE, Case


def commands_of(help_text):
    return re.findall(r"^  ([a-z-]+) +[a-z]", help_text, re.M)


class Words(Case):
    def setUp(self):
        super().setUp()
        self.commands = [word for word in commands_of(self.singe("--help")[0]) if word != "singe"]
        self.assertIn("run", self.commands)

    def help_of(self, command):
        """The command's help; "" where the build lacks the library that it needs."""
        done = subprocess.run([SINGE, command, "--help"], capture_output=True, text=True)
        if "built without" in done.stderr:
            return ""
        self.assertEqual((done.returncode, done.stderr), (0, ""), command)
        return done.stdout

    def test_every_help_has_examples_that_the_command_understands(self):
        for command in self.commands:
            text = self.help_of(command)
            if not text:
                continue
            examples = text.split("\nexamples:\n")[1].splitlines()
            lines = [line.strip() for line in examples if line.startswith("  singe ") or "singe completion" in line]
            self.assertTrue(lines, text)
            for line in lines:
                words = shlex.split(line.split(" > ")[0].split(" | ")[0].removeprefix('eval "$(').removesuffix(')"'))
                with self.subTest(line=line):
                    self.assertEqual(words[0], "singe")
                    if words[1] in ("validate", "paper", "bench"):  # they would run
                        words = words[:2] + ["--help"]
                    with tempfile.TemporaryDirectory() as empty:  # no scene is there, so nothing burns
                        done = subprocess.run([SINGE, *words[1:]], cwd=empty, capture_output=True, text=True,
                                              env={**os.environ, "HOME": empty}, timeout=60)
                    self.assertNotIn("--help", done.stderr)  # not a mistake of the command line

    def test_every_command_and_option_is_in_the_manual(self):
        self.singe("manual", "-o", self.path("man"))
        pages = sorted(os.listdir(self.path("man")))
        self.assertEqual(pages, sorted(["singe.1", *(f"singe-{command}.1" for command in self.commands)]))
        for command in self.commands:
            page = Path(self.path("man", f"singe-{command}.1")).read_text(encoding="utf-8").replace("\\-", "-")
            self.assertEqual(page, self.singe("manual", command)[0].replace("\\-", "-"))
            for option in re.findall(r"^  (?:-\w, |    )--([a-z-]+)", self.help_of(command), re.M):
                self.assertIn(f"\\fB--{option}\\fR", page)
        self.assertIn("did you mean 'render'?", self.singe("manual", "rendr", expect=2)[1])

    @unittest.skipUnless(shutil.which("man"), "man is not installed")
    def test_man_formats_the_pages_without_a_warning(self):
        self.singe("manual", "-o", self.path("man"))
        for page in "singe.1", "singe-run.1", "singe-bench.1":
            done = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", self.path("man", page)],
                                  capture_output=True, text=True, env={**os.environ, "MANWIDTH": "100", "LC_ALL": "C.UTF-8"})
            self.assertEqual((done.returncode, done.stderr), (0, ""), page)
            self.assertIn("singe", done.stdout)

    def completed(self, line):
        """What bash offers for the last word of a line."""
        words = line.split(" ")
        parts = [part for word in words for part in re.split(r"(=)", word)] if "=" in line else words
        script = (f'source <("{SINGE}" completion bash) || exit 9\nCOMP_WORDS=({shlex.join(parts)})\n'
                  f'COMP_CWORD={len(parts) - 1}\n_singe\nprintf "%s\\n" "${{COMPREPLY[@]}}"')
        done = subprocess.run(["bash", "--norc", "-c", script], capture_output=True, text=True, cwd=self.dir)
        self.assertEqual((done.returncode, done.stderr), (0, ""), line)
        return sorted(done.stdout.split("\n")[:-1]) if done.stdout != "\n" else []

    def test_bash_completes_commands_options_words_and_files(self):
        os.mkdir(self.path("a folder"))
        open(self.path("table.csv"), "w").close()
        self.assertEqual(self.completed("singe re"), ["render", "replay"])
        self.assertEqual(self.completed("singe run --re"), ["--record", "--resume"])
        self.assertEqual(self.completed("singe run "), ["a folder", "tiny.yaml"])
        self.assertEqual(self.completed("singe run -o "), ["a folder"])
        self.assertEqual(self.completed("singe run --output=a"), ["a folder"])
        self.assertEqual(self.completed("singe measure x --csv t"), ["table.csv", "tiny.yaml"])
        self.assertEqual(self.completed("singe convert x --to us"), ["usd", "usdz"])
        self.assertEqual(self.completed("singe convert x --to=gl"), ["glb"])
        self.assertEqual(self.completed("singe bench hea"), ["heap"])
        self.assertEqual(self.completed("singe completion "), ["bash", "fish", "zsh"])
        self.assertEqual(self.completed("singe help ver"), ["verify"])
        self.assertEqual(self.completed("singe run --threads "), [])

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_zsh_completes_commands_and_options(self):
        os.mkdir(self.path("functions"))
        Path(self.path("functions", "_singe")).write_text(self.singe("completion", "zsh")[0])
        # zsh has no call for this: a shell at a terminal of its own is typed into
        script = """
zmodload zsh/zpty
zpty z zsh -f -i
zpty -w z 'PS1=; unsetopt zle_bracketed_paste; fpath=(%s $fpath); autoload -Uz compinit; compinit -u -D; LISTMAX=9999; zstyle ":completion:*" list-separator "#"; bindkey "^I" complete-word; stty cols 200 rows 60; alias singe=%s; print READY$((1+1))'
zpty -r -m z line '*READY2*' || exit 9
zpty -w -n z $'%s\\t\\t'
sleep .5
while zpty -r -t z line; do print -rn -- $line; done
zpty -d z
"""
        for typed, found in (("singe re", ("render", "replay")), ("singe run --re", ("--record", "--resume")),
                             ("singe check ti", ("tiny.yaml",))):
            done = subprocess.run(["zsh", "-f", "-c", script % (self.path("functions"), shlex.quote(SINGE), typed)],
                                  capture_output=True, text=True, cwd=self.dir, timeout=60)
            for word in found:
                self.assertIn(word, done.stdout, (typed, done))

    @unittest.skipUnless(shutil.which("fish"), "fish is not installed")
    def test_fish_completes_commands_options_and_files(self):
        def offered(line):
            done = subprocess.run(["fish", "-N", "-c", f"{shlex.quote(SINGE)} completion fish | source; complete -C '{line}'"],
                                  capture_output=True, text=True, cwd=self.dir, env={**os.environ, "HOME": self.dir})
            self.assertEqual(done.stderr, "")
            return sorted(row.split("\t")[0] for row in done.stdout.splitlines())

        self.assertEqual(offered("singe re"), ["render", "replay"])
        self.assertEqual(offered("singe run --re"), ["--record", "--resume"])
        self.assertEqual(offered("singe convert x --to gl"), ["glb"])
        self.assertIn("tiny.yaml", offered("singe check ti"))

    def test_a_mistyped_word_brings_the_one_that_was_meant(self):
        for args, hint in ((["--verison"], "'--version'"), (["--hepl"], "'--help'"), (["chekc"], "'check'"),
                           (["tiny.yaml"], "'run tiny.yaml'"), (["convert", "x", "--sinlge"], "'--single'"),
                           (["bench", "frnt"], "'front'"), (["help", "swep"], "'sweep'")):
            self.assertIn("did you mean " + hint, self.singe(*args, expect=2)[1])
