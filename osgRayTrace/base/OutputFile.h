// OutputFile.h - writes files whole and keeps their other properties. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

namespace osgRayTrace::engine
{

/// Returns why nothing can be written to path, as one sentence; empty if path can be written to.
/// The question is asked before long work, whose result would be lost.
std::string whyNotWritable(const std::string& path);

/// Returns whether both paths lead to one regular file, or would create one, also by links. Devices
/// and pipes do not count: several writers may write to them.
bool isSameFile(const std::string& a, const std::string& b);

/// Lets write fill a temporary file, whose path write is given, and then puts the contents to path.
/// If write throws, or if there is no room, the file at path stays as it was and the exception is
/// passed on.
///
/// A file that does not exist yet, or that has one name, is put in place by a rename, so nobody
/// sees half of the file. Mode, owner and group stay. A rename would part hard links, lose access
/// control lists and other attributes, and fail on mounted files or in a folder of another user: in
/// these cases the contents are copied into the file, after space for them was reserved. Links are
/// followed, also links to a file that is still to be created. The contents are copied straight
/// into a destination that is no regular file (a device or a pipe), or that standard output or
/// standard error goes to.
void writeFileWhole(const std::string& path,
                    const std::function<void(const std::string& temporary)>& write);

} // namespace osgRayTrace::engine
