#!/usr/bin/env bash
# source.sh - makes a source package for Debian of the last commit, in build/source, and asks lintian about it. Whoever
# builds packages of it: dpkg-source -x build/source/osgraytrace_*.dsc, then dpkg-buildpackage in the folder that appears.
# SPDX-License-Identifier: MIT
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../setup.sh"

PACKAGES=(git dpkg-dev lintian)
install_packages
version=$(sed -n 's/^project(osgRayTrace VERSION \([0-9.]*\).*/\1/p' "$ROOT/CMakeLists.txt")
maintainer="${DEBFULLNAME:-The osgRayTrace developers} <${DEBEMAIL:-nobody@osgraytrace.invalid}>"
text=' osgRayTrace puts an OpenSceneGraph scene below one node and ray traces it on\n'
text+=' the CPU: soft shadows, reflections, glass, global illumination and caustics.'

folder=$ROOT/build/source
tree=$folder/osgraytrace-$version
rm -rf "$folder"
mkdir -p "$tree"
git -C "$ROOT" archive --prefix="osgraytrace-$version/" HEAD | gzip -9n >"$folder/osgraytrace_$version.orig.tar.gz"
tar -xzf "$folder/osgraytrace_$version.orig.tar.gz" -C "$folder"

mkdir -p "$tree/debian/source"
for file in control rules; do
    sed -e "s/@SOVERSION@/${version%.*}/g" -e "s/@MAINTAINER@/$maintainer/" -e "s/@TEXT@/$text/" \
        "$ROOT/cmake/packaging/source/$file" >"$tree/debian/$file"
done
chmod +x "$tree/debian/rules"
cp "$ROOT/cmake/packaging/copyright" "$tree/debian/copyright"
echo '3.0 (quilt)' >"$tree/debian/source/format"
cat >"$tree/debian/changelog" <<END
osgraytrace ($version-1) unstable; urgency=medium

  * Version $version; CHANGELOG.md in osgraytrace-doc says what is new.

 -- $maintainer  $(date -R -u -d "$(git -C "$ROOT" log -1 --format=%cI)")
END
(cd "$folder" && dpkg-source -b "osgraytrace-$version" >&2)
# The tags are those of packages that are not uploaded to Debian.
lintian --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs "$folder"/*.dsc
ls "$folder"/*.dsc
