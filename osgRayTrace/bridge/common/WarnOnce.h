// WarnOnce.h - a warning to the host's log that is not repeated. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgRayTrace::engine
{

/// Writes a message through osg::notify(WARN), once in the life of the process; without memory for
/// the message nothing is written. Any thread may call this.
void warnOnce(const std::string& message) noexcept;

/// Writes a message once for each subject, whatever the message is; otherwise as warnOnce.
void warnOnceFor(const std::string& subject, const std::string& message) noexcept;

/// Writes a message about one of any number of objects of a kind: the first of them in the life of
/// the process has its message, the second one has a line saying that there are more, and all
/// others have none. Otherwise as warnOnce.
void warnOfKind(const std::string& kind, const std::string& message) noexcept;

/// Forgets the kinds of warnOfKind, for tests that share a process.
void forgetKindsOfWarnings() noexcept;

} // namespace osgRayTrace::engine
