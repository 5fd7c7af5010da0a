// SharedChange.cpp - remembers comparisons of versions of scenes that still exist. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/history/SharedChange.h"

#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/NeverDestroyed.h"

#include <algorithm>
#include <mutex>
#include <vector>

namespace osgRayTrace::engine
{

namespace
{

using ScenePointer = std::shared_ptr<const TracedScene>;
using WeakScene = std::weak_ptr<const TracedScene>;

bool isSame(const WeakScene& a, const ScenePointer& b)
{
    return !a.owner_before(b) && !b.owner_before(a);
}

/// Holds what differs between two versions, once it is known.
struct Comparison
{
    WeakScene before, after;
    std::mutex mutex;
    bool known = false;
    std::optional<SceneChange> change;
};

/// Returns the comparison of the two versions, which may not be made yet. Comparisons with versions
/// that are gone are forgotten.
std::shared_ptr<Comparison> comparisonOf(const ScenePointer& before, const ScenePointer& after)
{
    static std::mutex mutex;
    static NeverDestroyed<std::vector<std::shared_ptr<Comparison>>> kept;
    const std::lock_guard<std::mutex> lock(mutex);
    std::vector<std::shared_ptr<Comparison>>& all = *kept;
    all.erase(std::remove_if(all.begin(), all.end(),
                             [](const std::shared_ptr<Comparison>& comparison) {
                                 return comparison->before.expired() || comparison->after.expired();
                             }),
              all.end());
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const std::shared_ptr<Comparison>& comparison) {
                                        return isSame(comparison->before, before) &&
                                               isSame(comparison->after, after);
                                    });
    if (found != all.end()) return *found;
    all.push_back(std::make_shared<Comparison>());
    all.back()->before = before;
    all.back()->after = after;
    return all.back();
}

} // namespace

std::shared_ptr<const SceneChange> sharedChange(const ScenePointer& before,
                                                const ScenePointer& after)
{
    const std::shared_ptr<Comparison> comparison = comparisonOf(before, after);
    const std::lock_guard<std::mutex> lock(comparison->mutex);
    if (!comparison->known) comparison->change = sceneChange(before->scene(), after->scene());
    comparison->known = true;
    if (!comparison->change) return {};
    return {comparison, &*comparison->change};
}

} // namespace osgRayTrace::engine
