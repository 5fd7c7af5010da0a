// WarnOnce.h - a warning to the host's log that is not repeated. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgRayTrace::engine
{

/// Says a message through osg::notify(WARN), once in the life of the process; not at all if
/// there is no memory left for that. Any thread.
void warnOnce(const std::string& message) noexcept;

/// The same, once for each subject, whatever the message is.
void warnOnceFor(const std::string& subject, const std::string& message) noexcept;

} // namespace osgRayTrace::engine
