#!/usr/bin/env bash
# scripts/build configures tests only on request, needs none of their packages, and does not change a
# tree that scripts/test has configured. Configures a copy of this tree; builds nothing.
# Usage: build_test.sh SOURCE_DIR CMAKE
set -euo pipefail
source_dir=$(realpath "$1")
real_cmake=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
tree=$work/tree

mkdir -p "$tree/web/node_modules" "$tree/web/dist" "$work/bin"
for entry in "$source_dir"/*; do
  case "${entry##*/}" in build | web | runs | datasets) ;; *) ln -s "$entry" "$tree" ;; esac
done
touch "$tree/web/package-lock.json" "$tree/web/node_modules/.overfly-lock"
touch "$tree/web/dist/index.html"

# A machine where every package is installed, as far as its list says, and nothing is compiled.
program() {
  cat >"$work/bin/$1"
  chmod +x "$work/bin/$1"
}
program dpkg-query <<<'#!/bin/sh
echo installed'
program cmake <<EOF
#!/bin/sh
[ "\$1" != --build ] || { echo "\$*" >>"$work/built"; exit 0; }
exec "$real_cmake" "\$@" \$OVERFLY_TEST_CMAKE_ARGUMENTS
EOF

build() { PATH="$work/bin:$PATH" "$tree/scripts/build" "$@"; }
tests_are() { grep -qx "OVERFLY_TESTS:BOOL=$1" "$tree/build/release/CMakeCache.txt"; }
fail() {
  echo "FAILED: $*" >&2
  exit 1
}
# One package of the tests is installed, another one is not to be found.
without_benchmark=-DCMAKE_DISABLE_FIND_PACKAGE_benchmark=TRUE

OVERFLY_TEST_CMAKE_ARGUMENTS=$without_benchmark build || fail "a missing test package stops the build"
tests_are OFF || fail "tests are configured though nobody asked"
grep -q -- '--target overfly$' "$work/built" || fail "built more than the program"

! OVERFLY_TEST_CMAKE_ARGUMENTS=$without_benchmark build -DOVERFLY_TESTS=ON 2>"$work/refusal" ||
  fail "tests were asked for and left out without a word"
grep -q benchmark "$work/refusal" || fail "the refusal does not name the package"

OVERFLY_TEST_CMAKE_ARGUMENTS=-DCMAKE_DISABLE_FIND_PACKAGE_benchmark=FALSE \
  build -DOVERFLY_TESTS=ON || fail "cannot configure the tests"
tests_are ON || fail "tests are not configured though asked for"
OVERFLY_TEST_CMAKE_ARGUMENTS= build || fail "cannot build after the tests"
tests_are ON || fail "scripts/build threw the tests of scripts/test away"

OVERFLY_TEST_CMAKE_ARGUMENTS=$without_benchmark build ||
  fail "a test package that was removed stops the build"
tests_are OFF || fail "tests are configured without their package"

# The bundle needs fewer npm packages than the dashboard's tests.
program npm <<EOF
#!/bin/sh
echo "\$*" >>"$work/npm"
EOF
installed() {
  : >"$work/npm"
  OVERFLY_TEST_CMAKE_ARGUMENTS=-DCMAKE_DISABLE_FIND_PACKAGE_benchmark=FALSE build "$@" ||
    fail "cannot build"
  grep -o '^ci.*--omit=dev\|^ci' "$work/npm" | cut -d ' ' -f 1,2 || true
}
echo '{}' >"$tree/web/package-lock.json"
touch "$tree/web/dist/index.html"
[[ $(installed) == "ci --omit=dev" ]] || fail "did not install the bundle's npm packages only"
[[ -z $(installed) ]] || fail "installed the bundle's npm packages twice"
[[ $(installed -DOVERFLY_TESTS=ON) == ci ]] || fail "did not install the npm packages of the tests"
[[ -z $(installed) ]] || fail "installed npm packages though all are there"
