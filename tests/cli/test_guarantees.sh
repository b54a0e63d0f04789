#!/bin/bash
# check_guarantees.py must notice promises without tests and tests that are gone: test_guarantees.sh SCRIPT BUILD
set -euo pipefail
script=$1 build=$2
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir "$tree/tests"
echo 'TEST(a_case) {' >"$tree/tests/test_a.c"
echo '    def test_other(self):' >"$tree/tests/test_b.py"
echo 'torture:' >"$tree/Makefile"

# expect RESULT TEXT: a page with that text
expect() {
    printf '%b\n' "$2" >"$tree/page.md"
    local result=good
    "$script" "$tree" "$build" page.md >/dev/null 2>&1 || result=bad
    [ $result = "$1" ] || { echo "expected $1, was $result: $2"; exit 1; }
}

expect good '- It holds. [arrows: a_case]'
expect good '- It holds,\n  and more. [arrows: a_case, other; make torture]'
expect good '- It holds. [arrows]\n- It holds. [not tested: no such machine]'
expect bad 'Only prose.'
expect bad '- It holds.'
expect bad '- It holds. [arrows: a_case]\n- It holds.'
expect bad '- It holds. [no_such_test: a_case]'
expect bad '- It holds. [arrows: no_such_case]'
expect bad '- It holds. [make nothing]'
expect bad '- It holds. [not tested:]'
