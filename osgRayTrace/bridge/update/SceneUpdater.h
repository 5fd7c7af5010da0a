// SceneUpdater.h - keeps the traced scene up to date with its scene graph. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/bridge/changes/GraphWatch.h"
#include "osgRayTrace/bridge/common/ObjectIdentity.h"
#include "osgRayTrace/bridge/common/ViewingConditions.h"
#include "osgRayTrace/bridge/convert/SceneConverter.h"
#include "osgRayTrace/bridge/geometry/HostArrays.h"
#include "osgRayTrace/bridge/update/SceneVersion.h"
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

/// Update converts the scene, and draw takes the version that there is. Cull records which cameras
/// look at the scene: the first of them, as long as it looks, is the reference for what all views
/// share (levels of detail, the light that osgViewer adds, the background colour).
class SceneUpdater
{
public:
    /// A camera is about to draw the scene. Cull threads.
    void recordView(const ObjectName& camera, const osg::FrameStamp* frameStamp,
                    const ViewingConditions& conditions);

    /// True once a view was recorded. Any thread.
    bool isViewed() const;

    /// Records that the camera has drawn from eye with its near plane at a distance. One engine
    /// origin has to serve near things and far ones, see kOriginDistance. Draw threads.
    void recordDrawn(const ObjectName& camera, const osg::Vec3d& eye, double nearDistance);

    /// Takes the settings over and redoes what changed in the graph, in the settings or in the
    /// recorded conditions. The graph is looked at once for a frame number, unless the conditions
    /// changed. Null root: there is no scene. Does not throw: a failure leaves the last version and
    /// is in the statistics. Update and cull threads.
    void update(osg::Node* root, const RayTraceSettings& settings,
                const osg::FrameStamp* frameStamp);

    /// Keeps no node of the graph alive until the next update, which converts. This is for times
    /// when there may be no update. Threads that may change the graph.
    void releaseGraph();

    /// Makes the next update convert, whatever it sees, and read all arrays and images again. Any
    /// thread.
    void setDirty();

    /// Returns the version of the last frame with its pickIndex, which is made from now on; if no
    /// view was recorded, the graph as it is now. start: where the ray begins, in the scene.
    /// Threads that may look at the graph.
    SceneVersion versionToPick(osg::Node* root, const RayTraceSettings& settings,
                               const osg::Vec3d& start);

    /// Any thread.
    SceneVersion version() const;

    /// Returns the scene's part; ok and message are those of the last conversion. Any thread.
    Statistics statistics() const;

private:
    /// Beyond this many near distances from the eye, float coordinates are coarser than a pixel.
    static constexpr double kOriginDistance = 2048.0;

    /// Requests to the next update.
    struct Requests
    {
        bool dirty = false;  ///< it shall convert, whatever it sees
        bool forget = false; ///< it shall take nothing for unchanged
        std::optional<osg::Vec3d> origin;
        ConversionCause cause = ConversionCause::None; ///< why dirty is set; None: at the beginning
    };

    struct Recorded
    {
        ObjectName camera;            ///< the reference camera
        unsigned int frameNumber = 0; ///< the frame in which it was last seen
        unsigned int othersSince = 0; ///< passes of other cameras since then
        std::optional<ViewingConditions> conditions;
        Requests asked{true, false, {}, ConversionCause::None};
    };

    std::optional<ViewingConditions> takeRecorded();
    void takeSettings(const RayTraceSettings& settings);
    void convertIfChanged(osg::Node* root, const ViewingConditions& conditions,
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

    HostArraysRelease _release;        // destroyed after all that holds arrays
    mutable std::mutex _recordedMutex; // cull and draw threads write, update reads
    Recorded _recorded;

    mutable std::mutex _versionMutex; // update and cull threads write, draw reads
    SceneVersion _version;
    Statistics _statistics;

    std::atomic<bool> _picks{false}; ///< somebody has picked; never taken back

    std::mutex _updateMutex; // guards all below: one update or cull thread at a time
    SceneConverter _converter;
    Requests _asked; ///< requests that are not served yet: what comes before may throw
    /// A copy of the settings of the last update: the same copy until they change.
    osg::ref_ptr<const RayTraceSettings> _settings;
    osg::ref_ptr<const RayTraceSettings> _settingsOf; ///< the settings that were copied
    unsigned int _settingsCount = 0;                  ///< count of their changes at that time
    std::shared_ptr<Workers> _workers;
    std::optional<unsigned int> _frameNumber; ///< last looked at
    // What the last look and the last conversion, successful or not, were for:
    std::optional<ViewingConditions> _conditions;
    ConversionSettings _conversionSettings;
    MaterialLibraryFile _materialFile;
    ObjectName _root;
    GraphWatch _watch;
    bool _released = true; ///< see releaseGraph()
    Statistics _done;      ///< the totals alone
    bool _stale = false;   ///< the last conversion failed: the converter has not seen all changes
    std::optional<osg::Vec3d> _origin;
};

} // namespace osgRayTrace::engine
