// SceneUpdater.h - keeps the traced scene up to date with its scene graph. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/CheckedMutex.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/bridge/changes/GraphWatch.h"
#include "osgRayTrace/bridge/common/ObjectIdentity.h"
#include "osgRayTrace/bridge/common/ViewingConditions.h"
#include "osgRayTrace/bridge/convert/SceneConverter.h"
#include "osgRayTrace/bridge/geometry/HostArrays.h"
#include "osgRayTrace/bridge/update/SceneVersion.h"
#include "osgRayTrace/bridge/update/ViewMasks.h"
#include "osgRayTrace/photons/PhotonPasses.h"

#include <osgRayTrace/RayTraceSettings>
#include <osgRayTrace/Statistics>

#include <osg/FrameStamp>

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>

namespace osgRayTrace::engine
{

class ServerPool; // servers: those who trace tiles elsewhere

/// Keeps the traced scene up to date: the update traversal converts the scene, and draw threads
/// take the current version. The cull traversal records which cameras look at the scene: the first
/// camera, as long as it looks, is the reference for what all views share (levels of detail, the
/// light that osgViewer adds, the background colour).
class SceneUpdater
{
public:
    /// Records that a camera is about to draw the scene. Cull threads may call this.
    /// visitor runs nodes that draw in cull alone; null: they are not run.
    void recordView(const ObjectName& camera, const osg::FrameStamp* frameStamp,
                    const ViewingConditions& conditions, osgUtil::CullVisitor* visitor = nullptr);

    /// Returns true once a view was recorded. Any thread may call this.
    bool isViewed() const;

    /// Records that the camera has drawn from eye with its near plane at nearDistance. One engine
    /// origin has to serve near things and far ones, see kOriginDistance. The origin follows the
    /// reference camera, and cameras whose eye is near its eye. Draw threads may call this.
    void recordDrawn(const ObjectName& camera, const osg::Vec3d& eye, double nearDistance);

    /// Takes the settings over and redoes what changed in the graph, in the settings or in the
    /// recorded conditions. The graph is looked at once for a frame number, unless the conditions
    /// changed. A null root means that there is no scene. The function does not throw: a failure
    /// leaves the last version and is in the statistics. Update and cull threads may call this.
    void update(osg::Node* root, const RayTraceSettings& settings,
                const osg::FrameStamp* frameStamp);

    /// Releases all nodes of the graph until the next update, which converts. This is for times
    /// when there may be no update. Threads that may change the graph may call this.
    void releaseGraph();

    /// Makes the next update convert, whatever it sees, and read all arrays and images again. Any
    /// thread may call this.
    void setDirty();

    /// Returns the version of the last frame with its pickIndex, which is made from now on. If no
    /// view was recorded, this returns a version of the graph as it is now. The ray begins at the
    /// point start of the scene. Threads that may look at the graph may call this.
    SceneVersion versionToPick(osg::Node* root, const RayTraceSettings& settings,
                               const osg::Vec3d& start);

    /// Returns the current version. Any thread may call this.
    SceneVersion version() const;

    /// Returns the scene's part of the statistics; ok and message are those of the last conversion.
    /// Any thread may call this.
    Statistics statistics() const;

private:
    /// Beyond this many near distances from the eye, float coordinates are coarser than a pixel.
    static constexpr double kOriginDistance = 2048.0;

    /// The requests go to the next update.
    struct Requests
    {
        bool dirty = false;  ///< request to convert, whatever the update sees
        bool forget = false; ///< request to take nothing for unchanged
        std::optional<osg::Vec3d> origin;
        ConversionCause cause = ConversionCause::None; ///< cause of dirty; None: first conversion
    };

    struct Recorded
    {
        ObjectName camera;            ///< reference camera
        unsigned int frameNumber = 0; ///< frame in which the camera was last seen
        unsigned int othersSince = 0; ///< passes of other cameras since the last of this one
        std::optional<ViewingConditions> conditions;
        ViewMasks masks;
        Requests asked{true, false, {}, ConversionCause::None};
    };

    std::optional<ViewingConditions> takeRecorded(const osg::FrameStamp* frameStamp);
    void takeSettings(const RayTraceSettings& settings);
    void convertIfChanged(osg::Node* root, ViewingConditions conditions,
                          const osg::FrameStamp* frameStamp);
    ConversionCause causeToConvert(bool sameRoot, const ViewingConditions& conditions,
                                   const ConversionSettings& settings) const;
    void recordReason(const ConversionReason& reason);
    GraphChanges look(osg::Node& root, bool same, bool sameRoot,
                      const ViewingConditions& conditions);
    ConversionResult convert(osg::Node& root, const ViewingConditions& conditions);
    void build(const ConversionResult& conversion);
    void publish(std::shared_ptr<const TracedScene> scene, const ConversionResult& conversion,
                 const Statistics& statistics);
    void fail(const char* message) noexcept;

    HostArraysRelease _release;        // last member to be destroyed: the others hold arrays
    mutable std::mutex _recordedMutex; // lock of what cull and draw threads write and update reads
    Recorded _recorded;

    mutable std::mutex _versionMutex; // lock of what update and cull threads write and draw reads
    SceneVersion _version;
    Statistics _statistics;

    std::atomic<bool> _picks{false}; ///< whether anybody has ever picked

    CheckedMutex _updateMutex; // lock of all below: one update or cull thread at a time
    SceneConverter _converter;
    Requests _asked; ///< requests not served yet, since earlier steps may throw
    /// This copy of the last update's settings stays the same until the settings change.
    osg::ref_ptr<const RayTraceSettings> _settings;
    osg::ref_ptr<const RayTraceSettings> _settingsOf; ///< settings that were copied
    unsigned int _settingsCount = 0;                  ///< count of the settings' changes then
    std::shared_ptr<Workers> _workers;
    std::shared_ptr<ServerPool> _servers;     ///< null: the settings name none
    std::optional<unsigned int> _frameNumber; ///< frame of the last look
    // The last look and the last conversion, successful or not, were for these:
    std::optional<ViewingConditions> _conditions;
    ConversionSettings _conversionSettings;
    MaterialLibraryFile _materialFile;
    ObjectName _root;
    GraphWatch _watch;
    bool _released = true; ///< see releaseGraph()
    Statistics _done;      ///< totals alone
    bool _stale = false;   ///< whether the last conversion failed and missed changes
    std::optional<osg::Vec3d> _origin;
};

} // namespace osgRayTrace::engine
