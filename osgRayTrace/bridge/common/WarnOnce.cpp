// WarnOnce.cpp - a warning to the host's log that is not repeated. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/WarnOnce.h"

#include "osgRayTrace/base/NeverDestroyed.h"

#include <osg/Notify>

#include <exception>
#include <mutex>
#include <unordered_set>

namespace osgRayTrace::engine
{

namespace
{

/// Number of messages before silence, because a scene may hold any number of bad objects.
constexpr size_t kMostMessages = 4096;

/// Returns whether a subject is seen for the first time.
bool isNew(const std::string& subject)
{
    static std::mutex mutex;
    static NeverDestroyed<std::unordered_set<std::string>> said; // guarded by mutex
    const std::lock_guard<std::mutex> lock(mutex);
    return said->size() < kMostMessages && said->insert(subject).second;
}

} // namespace

void warnOnce(const std::string& message) noexcept
{
    warnOnceFor(message, message);
}

void warnOnceFor(const std::string& subject, const std::string& message) noexcept
try
{
    if (isNew(subject)) OSG_WARN << "osgRayTrace: " << message << std::endl;
}
catch (const std::exception&)
{
}

} // namespace osgRayTrace::engine
