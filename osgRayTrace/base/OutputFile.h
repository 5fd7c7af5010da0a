// OutputFile.h - writes files whole, and keeps what else there is to a file. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

namespace osgRayTrace::engine
{

/// Why nothing can be written to path, as one sentence; empty if it can. Asked before long work,
/// whose result would be lost.
std::string whyNotWritable(const std::string& path);

/// Whether both paths lead to one regular file, or would create one: by links, too. Devices and
/// pipes may be written to by several.
bool isSameFile(const std::string& a, const std::string& b);

/// Lets write fill a temporary file, of the path that it is given, and puts the contents to path
/// then. If write throws, or if there is no room, what was at path stays and the exception is
/// passed on.
///
/// A file that does not exist yet, or that has one name, comes by a rename: nobody sees half of it.
/// Its mode, owner and group stay. A rename would part hard links, lose access control lists and
/// other attributes, and fail on what is mounted or in a folder that is not ours: there the
/// contents are copied into the file, after its space was reserved. Links are followed, also those
/// to a file that is still to be created. Into what is no regular file (devices, pipes), and into
/// what standard output or standard error goes to, the contents are copied straight.
void writeFileWhole(const std::string& path,
                    const std::function<void(const std::string& temporary)>& write);

} // namespace osgRayTrace::engine
