// WarnOnce.cpp - a warning to the host's log that is not repeated. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/WarnOnce.h"

#include "osgRayTrace/base/NeverDestroyed.h"

#include <osg/Notify>

#include <exception>
#include <map>
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

/// What has been written about the objects of a kind.
struct Kind
{
    std::string first; ///< message of the first object
    bool others = false;
};

struct Kinds
{
    std::mutex mutex;
    std::map<std::string, Kind> byName; // guarded by mutex
};

Kinds& kinds()
{
    static NeverDestroyed<Kinds> kinds;
    return *kinds;
}

/// Returns what has to be written about another object; nothing if it is empty.
std::string lineFor(const std::string& name, const std::string& message)
{
    const std::lock_guard<std::mutex> lock(kinds().mutex);
    const auto [entry, isFirst] = kinds().byName.try_emplace(name, Kind{message});
    Kind& kind = entry->second;
    if (isFirst) return message;
    if (kind.others || kind.first == message) return {};
    kind.others = true;
    return name + ": there are more, which the conversion report counts";
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

void warnOfKind(const std::string& kind, const std::string& message) noexcept
try
{
    const std::string line = lineFor(kind, message);
    if (!line.empty()) OSG_WARN << "osgRayTrace: " << line << std::endl;
}
catch (const std::exception&)
{
}

void forgetKindsOfWarnings() noexcept
{
    const std::lock_guard<std::mutex> lock(kinds().mutex);
    kinds().byName.clear();
}

} // namespace osgRayTrace::engine
