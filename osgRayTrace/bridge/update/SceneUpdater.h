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

/// What a draw thread needs to trace a view. Immutable: it stays what it is while update goes on.
struct SceneVersion
{
    std::shared_ptr<const TracedScene>
        scene; ///< null: there is none yet, or none that can be traced
    std::shared_ptr<Workers> workers;
    std::shared_ptr<PhotonPasses> photons; ///< of all views
    osg::ref_ptr<const RayTraceSettings> settings;
    std::shared_ptr<const RasterizedParts> rasterized; ///< for OSG to draw; null: as scene
    std::shared_ptr<const PickIndex>
        pickIndex;      ///< null: nobody has picked since something came or went
    bool paged = false; ///< see ConversionResult
};

/// Update converts, draw takes the version there is. Cull records who looks at the scene: the first
/// camera that did, as long as it does, is the reference for what all views share (levels of
/// detail, the light that osgViewer adds, the background colour).
class SceneUpdater
{
public:
    /// A camera is about to draw the scene. Cull threads.
    void recordView(const ObjectName& camera, const osg::FrameStamp* frameStamp,
                    const ViewingConditions& conditions);

    /// True once a view was recorded. Any thread.
    bool isViewed() const;

    /// The camera has drawn from eye with its near plane at a distance; one engine origin has to
    /// serve near things and far ones, see kOriginDistance. Draw threads.
    void recordDrawn(const ObjectName& camera, const osg::Vec3d& eye, double nearDistance);

    /// Takes the settings over and redoes what changed of the graph, of the settings or of the
    /// recorded conditions; once for a frame number, unless the latter did. Null root: no scene.
    /// Update and cull threads. Does not throw: a failure leaves the last version and is in the
    /// statistics.
    void update(osg::Node* root, const RayTraceSettings& settings,
                const osg::FrameStamp* frameStamp);

    /// Keeps no node of the graph alive until the next update, which converts. For when there may
    /// be none. Threads that may change the graph.
    void releaseGraph();

    /// The next update converts, whatever it sees, with all arrays and images read again. Any
    /// thread.
    void setDirty();

    /// The version as of the last frame with its pickIndex, which is made from now on; as of now if
    /// no view was recorded. start: of the ray, in the scene. Threads that may look at the graph.
    SceneVersion versionToPick(osg::Node* root, const RayTraceSettings& settings,
                               const osg::Vec3d& start);

    /// Any thread.
    SceneVersion version() const;

    /// The scene's part; ok and message are those of the last conversion. Any thread.
    Statistics statistics() const;

private:
    /// Beyond this many near distances from the eye, float coordinates are coarser than a pixel.
    static constexpr double kOriginDistance = 2048.0;

    /// What the next update shall do.
    struct Requests
    {
        bool dirty = false;  ///< convert, whatever there is to see
        bool forget = false; ///< and take nothing for unchanged
        std::optional<osg::Vec3d> origin;
        ConversionCause cause = ConversionCause::None; ///< why dirty is set; None: at the beginning
    };

    struct Recorded
    {
        ObjectName camera;            ///< the reference
        unsigned int frameNumber = 0; ///< it was last seen in
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

    HostArraysRelease _release;        // after all that holds arrays
    mutable std::mutex _recordedMutex; // cull and draw threads write, update reads
    Recorded _recorded;

    mutable std::mutex _versionMutex; // update and cull threads write, draw reads
    SceneVersion _version;
    Statistics _statistics;

    std::atomic<bool> _picks{false}; ///< somebody has picked; never taken back

    std::mutex _updateMutex; // all below; one update or cull thread at a time
    SceneConverter _converter;
    Requests _asked; ///< and not yet heard: what comes before may throw
    osg::ref_ptr<const RayTraceSettings>
        _settings; ///< as they were in the last update: the same copy until they change
    osg::ref_ptr<const RayTraceSettings> _settingsOf; ///< whose copy that is
    unsigned int _settingsCount = 0;                  ///< of its changes then
    std::shared_ptr<Workers> _workers;
    std::optional<unsigned int> _frameNumber; ///< last looked at
    // Last looked at for, and converted successfully or not:
    std::optional<ViewingConditions> _conditions;
    ConversionSettings _conversionSettings;
    MaterialLibraryFile _materialFile;
    ObjectName _root;
    GraphWatch _watch;
    bool _released = true; ///< see releaseGraph()
    Statistics _done;      ///< its totals alone
    bool _stale = false;   ///< the last conversion failed: the converter has not seen all changes
    std::optional<osg::Vec3d> _origin;
};

} // namespace osgRayTrace::engine
