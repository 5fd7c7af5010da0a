#!/usr/bin/env bash
# debian.sh - builds the packages for Debian into build/deb/packages, and lists their dependencies.
# SPDX-License-Identifier: MIT
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../setup.sh"

PACKAGES+=(dpkg-dev file)
install_packages
build deb
rm -rf "$ROOT/build/deb/packages"
(cd "$ROOT/build/deb" && cpack >&2)
for package in "$ROOT"/build/deb/packages/*.deb; do
    dpkg-deb --field "$package" Package Version Architecture Installed-Size Depends
    say "$(stat -c %s "$package") bytes"
done
