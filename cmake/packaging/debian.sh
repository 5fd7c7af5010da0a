#!/usr/bin/env bash
# debian.sh - builds the packages for Debian into build/deb/packages, lists their dependencies, and asks lintian about
# them; ends with 1 if it finds an error or a warning.
# SPDX-License-Identifier: MIT
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../setup.sh"

PACKAGES+=(dpkg-dev file lintian)
install_packages
build deb
rm -rf "$ROOT/build/deb/packages"
(cd "$ROOT/build/deb" && cpack >&2)
for package in "$ROOT"/build/deb/packages/*.deb; do
    dpkg-deb --field "$package" Package Version Architecture Installed-Size Depends
    say "$(stat -c %s "$package") bytes"
done
# The packages are not uploaded to Debian, and so close no bug of its tracker. Scripts for ldconfig are CPack's own.
lintian --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs,maintscript-calls-ldconfig \
    "$ROOT"/build/deb/packages/*.deb
