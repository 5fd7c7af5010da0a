// SceneUpdater.cpp - keeps the traced scene up to date with its scene graph. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/update/SceneUpdater.h"

#include "osgRayTrace/base/Status.h"
#include "osgRayTrace/bridge/common/WarnOnce.h"
#include "osgRayTrace/bridge/update/RenderOptionsFromSettings.h"
#include "osgRayTrace/bridge/update/StatisticsFromEngine.h"
#include "osgRayTrace/servers/LinkModule.h"

#include <cmath>
#include <exception>
#include <new>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

/// If this many passes of other cameras come without one of the reference camera, another camera
/// becomes the reference.
constexpr unsigned int kReferenceExpiry = 500;

unsigned int frameNumberOf(const osg::FrameStamp* frameStamp)
{
    return frameStamp ? frameStamp->getFrameNumber() : 0;
}

/// Returns the point, or zero if a singular view matrix gave no finite point.
osg::Vec3d finiteOrZero(const osg::Vec3d& point)
{
    return std::isfinite(point.length2()) ? point : osg::Vec3d();
}

/// Returns whether camera rays meet anything of a scene.
bool isSeen(const Scene& scene)
{
    const auto meets = [&scene](const Instance& instance)
    {
        return scene.materials[instance.material].culling != FaceCulling::FrontAndBack &&
               !scene.meshes[instance.mesh]->triangles.empty();
    };
    return !scene.volumes.empty() ||
           std::any_of(scene.instances.begin(), scene.instances.end(), meets) ||
           std::any_of(scene.lights.begin(), scene.lights.end(),
                       [](const Light& light) { return light.kind == LightKind::Environment; });
}

} // namespace

void SceneUpdater::recordView(const ObjectName& camera, const osg::FrameStamp* frameStamp,
                              const ViewingConditions& conditions, osgUtil::CullVisitor* visitor)
{
    const unsigned int frameNumber = frameNumberOf(frameStamp);
    std::lock_guard<std::mutex> lock(_recordedMutex);
    _recorded.masks.record(camera, conditions.traversalMask, frameStamp);
    if (_recorded.conditions && _recorded.camera != camera &&
        ++_recorded.othersSince < kReferenceExpiry)
        return;
    // The second pass of a camera in one frame is for its other eye.
    const bool again =
        frameStamp && _recorded.camera == camera && _recorded.frameNumber == frameNumber;
    _recorded.othersSince = 0;
    if (_recorded.conditions && again) return;
    _recorded.camera = camera;
    _recorded.frameNumber = frameNumber;
    const std::shared_ptr<CullPass> last =
        _recorded.conditions ? _recorded.conditions->pass : nullptr;
    _recorded.conditions = conditions;
    if (visitor) _recorded.conditions->pass = cullPass(*visitor, last);
}

bool SceneUpdater::isViewed() const
{
    std::lock_guard<std::mutex> lock(_recordedMutex);
    return _recorded.conditions.has_value();
}

void SceneUpdater::recordDrawn(const ObjectName& camera, const osg::Vec3d& eye, double nearDistance)
{
    const SceneVersion drawn = version();
    if (!drawn.inputs.scene) return;
    const Vec3d origin = drawn.inputs.scene->scene().origin;
    const double distance = (eye - osg::Vec3d(origin.x, origin.y, origin.z)).length();
    if (!(nearDistance > 0.0 && distance > kOriginDistance * nearDistance)) return;

    std::lock_guard<std::mutex> lock(_recordedMutex);
    // Slices of one picture are drawn by cameras of their own, and the reference camera may have
    // the last slice. An origin at the nearest slice's eye serves them all. A camera elsewhere
    // would take turns with the reference camera.
    const bool serves = camera == _recorded.camera ||
                        (_recorded.conditions && (eye - _recorded.conditions->eye).length() <=
                                                     kOriginDistance * nearDistance);
    if (serves) _recorded.asked.origin = eye;
}

void SceneUpdater::releaseGraph()
{
    std::lock_guard<CheckedMutex> lock(_updateMutex);
    if (std::exchange(_released, true)) return;
    _watch.forget();
    _converter.releaseGraph();
    _frameNumber.reset();
    _stale = true;
}

void SceneUpdater::setDirty()
{
    std::lock_guard<std::mutex> lock(_recordedMutex);
    _recorded.asked.dirty = _recorded.asked.forget = true;
    _recorded.asked.cause = ConversionCause::Dirty;
}

SceneVersion SceneUpdater::versionToPick(osg::Node* root, const RayTraceSettings& settings,
                                         const osg::Vec3d& start)
{
    SceneVersion now = version();
    const bool viewed = isViewed(); // frames keep a viewed scene up to date
    if (viewed && now.pickIndex) return now;
    _picks = true;
    {
        std::lock_guard<std::mutex> lock(_recordedMutex);
        if (!now.pickIndex)
        {
            _recorded.asked.dirty = true;
            if (_recorded.asked.cause == ConversionCause::None)
                _recorded.asked.cause = ConversionCause::Picking;
        }
        if (!viewed && !now.inputs.scene) _recorded.asked.origin = start;
    }
    update(root, settings, nullptr);
    return version();
}

SceneVersion SceneUpdater::version() const
{
    std::lock_guard<std::mutex> lock(_versionMutex);
    return _version;
}

Statistics SceneUpdater::statistics() const
{
    std::lock_guard<std::mutex> lock(_versionMutex);
    Statistics statistics = _statistics;
    if (_version.inputs.scene) statistics.embreeBytes = _version.inputs.scene->embreeBytes();
    return statistics;
}

void SceneUpdater::update(osg::Node* root, const RayTraceSettings& settings,
                          const osg::FrameStamp* frameStamp)
{
    std::lock_guard<CheckedMutex> lock(_updateMutex);
    releaseHostArrays();
    try
    {
        takeSettings(settings);
        convertIfChanged(root, takeRecorded(frameStamp).value_or(ViewingConditions()), frameStamp);
    }
    catch (const std::bad_alloc&)
    {
        fail("there is not enough memory to convert the scene");
    }
    catch (const std::exception& error)
    {
        fail(error.what());
    }
    catch (...)
    {
        fail("the scene could not be converted");
    }
}

/// Takes the requests over and returns the conditions of the reference camera, with the masks of
/// all views.
std::optional<ViewingConditions> SceneUpdater::takeRecorded(const osg::FrameStamp* frameStamp)
{
    OSGRAYTRACE_ASSERT(_updateMutex.isHeld());
    std::lock_guard<std::mutex> lock(_recordedMutex);
    const Requests more = std::exchange(_recorded.asked, Requests());
    _asked.dirty |= more.dirty;
    _asked.forget |= more.forget;
    if (more.cause != ConversionCause::None) _asked.cause = more.cause;
    if (more.origin) _asked.origin = more.origin;
    std::optional<ViewingConditions> conditions = _recorded.conditions;
    if (!conditions) return conditions;
    std::vector<unsigned int> masks = _recorded.masks.inUse(frameStamp);
    conditions->traversalMask = 0;
    for (const unsigned int mask : masks)
        conditions->traversalMask |= mask;
    if (masks.size() > 1) conditions->viewMasks = std::move(masks);
    return conditions;
}

void SceneUpdater::takeSettings(const RayTraceSettings& settings)
{
    OSGRAYTRACE_ASSERT(_updateMutex.isHeld());
    // The settings are set last: they are there only if all else is.
    if (!_settings || _settings->getThreads() != settings.getThreads())
        _workers = std::make_shared<Workers>(settings.getThreads());
    if (!_settings || _settings->getServers() != settings.getServers())
        _servers = openServers(settings.getServers());
    if (_servers)
        for (const std::string& note : _servers->takeNotes())
            warnOnce(note);
    if (_settingsOf != &settings || _settingsCount != settings.getModifiedCount())
    {
        _settings = new RayTraceSettings(settings);
        _settingsOf = &settings;
        _settingsCount = settings.getModifiedCount();
    }

    std::lock_guard<std::mutex> lock(_versionMutex);
    _version.settings = _settings;
    ViewInputs& inputs = _version.inputs;
    setInputs(inputs, *_settings);
    inputs.workers = _workers;
    inputs.help = _servers;
    if (!inputs.photons) inputs.photons = std::make_shared<PhotonPasses>();
}

void SceneUpdater::convertIfChanged(osg::Node* root, ViewingConditions conditions,
                                    const osg::FrameStamp* frameStamp)
{
    OSGRAYTRACE_ASSERT(_updateMutex.isHeld());
    const bool seen = frameStamp && _frameNumber == frameStamp->getFrameNumber();
    const ConversionSettings settings = conversionSettings(
        *_settings, _materialFile.materials(_settings->getMaterials(), _asked.dirty));
    if (settings.materials) conditions.reads = settings.materials->reads;
    const bool sameView = _conditions && keepSame(*_conditions, conditions);
    const bool sameRoot = _root == root;
    const ConversionCause cause = causeToConvert(sameRoot, conditions, settings);
    const bool same = cause == ConversionCause::None && !_asked.dirty;
    if (seen && same && sameView) return;
    if (frameStamp) _frameNumber = frameStamp->getFrameNumber();
    if (!root && same) return;

    _root = root;
    _conditions = conditions;
    _conversionSettings = settings;
    if (_asked.origin || !_origin) _origin = finiteOrZero(_asked.origin.value_or(conditions.eye));
    if (!root)
    {
        _asked = Requests();
        _watch.forget();
        _converter.releaseGraph();
        publish(nullptr, ConversionResult(), _done);
        return;
    }
    _released = false;
    // Cull traversals may change the graph, so the look at the graph comes after them.
    const CullChanges cull = same ? _converter.lookInCull(conditions) : CullChanges();
    GraphChanges changes = look(*root, same, sameRoot, conditions);
    _converter.addCullChanges(cull, changes);
    if (!same) changes.reason.cause = cause;
    if (!sameView) changes.view = {conditions.clearColor, conditions.light};
    const Requests asked = std::exchange(_asked, Requests());
    if (changes.none()) return;

    const bool wasStale = std::exchange(_stale, true);
    if (asked.forget) _converter.forget();
    PatchResult patch;
    if (changes.convert)
        patch.reason = changes.reason;
    else if (wasStale)
        patch.reason.cause = ConversionCause::FailedBefore;
    else
        patch = _converter.patch(changes, conditions);
    if (!patch.conversion)
    {
        recordReason(patch.reason);
        patch.conversion = convert(*root, conditions);
    }
    else
        ++_done.patches;
    _stale = false;
    build(*patch.conversion);
}

/// Returns why the whole graph is converted, whatever has changed in it. None means that only
/// changes in the graph can be a reason, or that the conversion is the first one.
ConversionCause SceneUpdater::causeToConvert(bool sameRoot, const ViewingConditions& conditions,
                                             const ConversionSettings& settings) const
{
    OSGRAYTRACE_ASSERT(_updateMutex.isHeld());
    if (_asked.dirty) return _asked.cause;
    if (!sameRoot || !_conditions) return ConversionCause::OtherRoot;
    if (!convertAlike(*_conditions, conditions)) return ConversionCause::OtherConditions;
    if (!(settings == _conversionSettings)) return ConversionCause::OtherSettings;
    return _asked.origin ? ConversionCause::OtherOrigin : ConversionCause::None;
}

/// Counts a conversion and records its reason; the very first conversion has no reason.
void SceneUpdater::recordReason(const ConversionReason& reason)
{
    OSGRAYTRACE_ASSERT(_updateMutex.isHeld());
    const bool first = _done.conversions++ == 0;
    if (first) return;
    _done.lastConversionReason = textOf(reason.cause);
    _done.lastConversionPath =
        reason.geometry ? _watch.pathOf(*reason.geometry, reason.use) : reason.path;
}

/// Returns what has changed; the graph is remembered as it is now, whatever becomes of its
/// conversion.
GraphChanges SceneUpdater::look(osg::Node& root, bool same, bool sameRoot,
                                const ViewingConditions& conditions)
{
    OSGRAYTRACE_ASSERT(_updateMutex.isHeld());
    GraphChanges changes;
    changes.convert = !same;
    changes.record = !sameRoot;
    if (sameRoot)
    {
        // The watch looks even if the conditions differ: all changes are then known, and the next
        // look finds none of them.
        const ConvertedNodes converted = _converter.convertedNodes();
        GraphChanges found = _watch.look(root, conditions, &converted);
        const bool record = found.record;
        if (same) changes = std::move(found);
        changes.record = record;
        std::lock_guard<std::mutex> lock(_versionMutex);
        _statistics.walks = ++_done.walks;
    }
    if (changes.record) _watch.record(root, conditions);
    return changes;
}

ConversionResult SceneUpdater::convert(osg::Node& root, const ViewingConditions& conditions)
{
    OSGRAYTRACE_ASSERT(_updateMutex.isHeld());
    ConversionInput input;
    static_cast<ConversionSettings&>(input) = _conversionSettings;
    input.root = &root;
    input.eye = conditions.eye;
    input.view = conditions.view;
    input.pass = conditions.pass;
    input.origin = *_origin;
    input.traversalMask = conditions.traversalMask;
    input.viewMasks = conditions.viewMasks;
    input.viewLight = conditions.light;
    input.viewLightInEyeSpace = conditions.lightInEyeSpace;
    input.lighting = conditions.inheritedState.empty();
    input.inheritedState = conditions.inheritedState;
    input.clearColor = conditions.clearColor;
    input.rasterizesRest = true;
    input.picks = _picks;

    return _converter.convert(input);
}

void SceneUpdater::build(const ConversionResult& conversion)
{
    OSGRAYTRACE_ASSERT(_updateMutex.isHeld());
    std::shared_ptr<const TracedScene> traced = version().inputs.scene;
    if (!traced || &traced->scene() != conversion.scene.get())
    {
        traced = TracedScene::build(conversion.scene, _workers, traced);
        const BuildStatistics& result = traced->statistics();
        _done.builtMeshes += result.builtMeshes;
        _done.refitMeshes += result.refitMeshes;
        _done.staticBuilds += result.staticBuilds;
        _done.embreeCommits += result.commits;
    }
    _done.convertedMeshes = _converter.convertedMeshes();
    Statistics statistics = _done;
    setSceneStatistics(statistics, conversion, *traced);
    publish(std::move(traced), conversion, statistics);
}

void SceneUpdater::publish(std::shared_ptr<const TracedScene> scene,
                           const ConversionResult& conversion, const Statistics& statistics)
{
    std::shared_ptr<const RasterizedParts> rasterized = conversion.rasterized;
    const bool seen = isSeen(scene->scene());
    std::lock_guard<std::mutex> lock(_versionMutex);
    // The old scene and parts are freed after the lock, unless a view still draws them.
    _version.inputs.scene.swap(scene);
    _version.rasterized.swap(rasterized);
    _version.pickIndex = conversion.pickIndex;
    _version.paged = conversion.paged;
    _version.seen = seen;
    _statistics = statistics;
}

void SceneUpdater::fail(const char* message) noexcept
{
    std::lock_guard<std::mutex> lock(_versionMutex);
    _statistics.ok = false;
    _statistics.message = failureText(message);
    warnOnce(_statistics.message);
}

} // namespace osgRayTrace::engine
