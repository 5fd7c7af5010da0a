// SessionState.cpp - whether an image restarts, and what its passes are made from. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/SessionState.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/base/Assert.h"
#include "osgRayTrace/integrators/shared/IntegratorChoice.h"
#include "osgRayTrace/integrators/shared/SkyPortalFinder.h"
#include "osgRayTrace/integrators/shared/SurfaceSample.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the scene's lights, with those of eye space placed for the view. Empty if the scene has
/// none of eye space: there may be millions of other lights, which are good as they are.
std::vector<Light> placedLights(const Scene& scene, const View& view)
{
    const auto isEyeSpace = [](const Light& light) { return light.eyeSpace; };
    if (std::none_of(scene.lights.begin(), scene.lights.end(), isEyeSpace)) return {};
    std::vector<Light> lights = scene.lights;
    const Mat4d worldFromView = glm::inverse(view.viewFromWorld);
    const auto placed = [&](const Vec3& position) {
        return Vec3((Vec3d(worldFromView * Vec4d(Vec3d(position), 1.0)) - scene.origin) /
                    scene.unit);
    };
    for (Light& light : lights)
    {
        if (!light.eyeSpace) continue;
        light.position = placed(light.position);
        light.direction = glm::normalize(Vec3(glm::dmat3(worldFromView) * Vec3d(light.direction)));
        light.eyeSpace = false;
    }
    return lights;
}

/// Returns the distant lights that stand for the environment; empty if the options want none.
std::vector<EnvironmentStratum> strataOf(const TracedScene& scene, const RenderOptions& options)
{
    const PlacedEnvironment* environment = scene.lights().shiningEnvironment();
    if (!environment || options.environmentSampling != EnvironmentSampling::Structured) return {};
    return environment->strata(options.environmentSamples);
}

/// Returns the rotation alone: the axes are of length 1, whatever scale the view has.
Mat3 eyeFromEngine(const View& view)
{
    glm::dmat3 axes = glm::transpose(glm::dmat3(view.viewFromWorld));
    for (int i = 0; i < 3; ++i)
        axes[i] = glm::normalize(axes[i]);
    return Mat3(glm::transpose(axes));
}

/// Returns the distance of what is straight ahead of the eye [engine units]; 0: nothing is. What
/// the near plane cuts away counts: all depth slices of a picture have one focus.
double distanceAhead(const View& view, const CameraRays& rays, const TracedScene& traced)
{
    const auto hit = traced.intersector().closestHit(rays.origin, lineOfSight(view), 0.0f,
                                                     kInfinity, kCameraRays);
    return hit ? static_cast<double>(hit->t) : 0.0;
}

/// Returns the rays of a view as the options have its lens; nothing as cameraRays() does.
std::optional<CameraRays> raysOf(const View& view, const RenderOptions& options,
                                 const TracedScene& traced)
{
    const Scene& scene = traced.scene();
    std::optional<CameraRays> rays = cameraRays(view, scene.origin, scene.unit);
    if (!rays || !(options.aperture > 0.0f) || options.integrator == IntegratorKind::Debug)
        return rays;
    const double focus = static_cast<double>(options.focus);
    const double distance = focus > 0.0 ? focus / scene.unit : distanceAhead(view, *rays, traced);
    openLens(view, static_cast<double>(options.aperture) / scene.unit, distance, *rays);
    return rays;
}

/// Returns the integrator of an image. Hit points, which passes of Ppm share, do not outlast the
/// moment of a pass.
IntegratorKind integratorOf(const RenderOptions& options, const SceneTraits& traits)
{
    const IntegratorKind kind = chooseIntegrator(options.integrator, traits);
    return options.moving && kind == IntegratorKind::Ppm ? IntegratorKind::Sppm : kind;
}

/// Returns the view's origin in engine space.
Vec3 eyeOf(const View& view, const Scene& scene)
{
    const Vec3d eye(glm::inverse(view.viewFromWorld)[3]);
    return Vec3((eye - scene.origin) / scene.unit);
}

/// Returns what the chosen integrator makes of the scene's media.
MediumNote mediumNote(IntegratorKind wanted, IntegratorKind chosen, const SceneTraits& traits)
{
    const bool below = chosen == IntegratorKind::Whitted && traits.subsurface;
    if (!traits.media) return below ? MediumNote::DiffuseOnly : MediumNote::None;
    const bool single = chosen == IntegratorKind::Whitted && traits.scattering;
    if (wanted != IntegratorKind::Automatic && photonUse(wanted) != photonUse(chosen))
        return MediumNote::PathsInstead;
    if (single) return MediumNote::SingleOnly;
    return below ? MediumNote::DiffuseOnly : MediumNote::None;
}

} // namespace

/// Decides whether the image restarts or continues; nothing else does. Returns true if there is
/// something to render.
bool SessionState::begin()
{
    const bool sameScene = scene == filmScene;
    const bool sameSize =
        view.width == film.width() && view.height == film.height(); // false after a failure
    const bool restart = !sameScene || !sameSize || view != filmView ||
                         options.needsRestart(filmOptions) || sumsKind != film.sumsKind() ||
                         firstPass != filmFirstPass || firstSums;
    progress.restarted = restart;
    progress.status = {};
    if (!scene)
    {
        progress.status = {StatusCode::EmptyScene, "there is no scene"};
        return false;
    }
    if (!restart) return true;

    std::optional<PassSums> sums = std::move(firstSums); // a render that fails forgets them
    firstSums.reset();
    const std::optional<CameraRays> rays = raysOf(view, options, *scene);
    if (!rays)
    {
        progress.status = {StatusCode::InvalidView,
                           "the view has no size, or matrices that cannot be inverted"};
        return false;
    }
    if (sums && (sums->width != view.width || sums->height != view.height))
    {
        progress.status = {StatusCode::InvalidView, "the sums of passes are of another size"};
        return false;
    }
    std::vector<Light> placed = engine::placedLights(
        scene->scene(), view); // placed before the film changes, as placing may throw
    std::vector<EnvironmentStratum> newStrata = strataOf(*scene, options);
    const bool continues = continuesView && sameSize && view == filmView;
    if (!continues && film.passes() > 0 && surfaces.finished) std::swap(surfaces, lastSurfaces);
    resetFilm(continues, sums ? &*sums : nullptr);
    photons.reset(film.tileCount());
    camera = *rays;
    filmScene = scene;
    filmView = view;
    filmOptions = options;
    filmSeed =
        sequence == 0 ? options.seed : hash(options.seed, sequence + 1); // halves have 0 and 1
    filmCentred = centred;
    placedLights = std::move(placed);
    strata = std::move(newStrata);
    portals.reset();
    progress = RenderProgress();
    progress.restarted = true;
    photonsCounted = 0;
    progress.integrator = integratorOf(options, scene->traits());
    progress.mediumNote = mediumNote(options.integrator, progress.integrator, scene->traits());
    photons.setOptional(!options.moving && photonsAreOptional(options.integrator, scene->traits()));
    hasSamples = false;
    if (options.centredFirstPass && progress.integrator != IntegratorKind::Debug)
    {
        samples.resize(static_cast<std::size_t>(view.width) *
                       static_cast<std::size_t>(view.height));
        hasSamples = true;
    }
    if (!keepsSurfaces) surfaces = lastSurfaces = SurfaceMap();
    if (continues) return true;
    surfaces.view = View();
    if (keepsSurfaces && progress.integrator != IntegratorKind::Debug)
        beginSurfaceMap(view, surfaces);
    return true;
}

/// Takes over the wanted scene, view and options without a film, for tiles of others' films.
/// Returns false if the view cannot be traced.
bool SessionState::beginView()
{
    filmScene.reset();
    if (!scene || int64_t(view.width) * view.height > Film::kMaxPixels) return false;
    const std::optional<CameraRays> rays = raysOf(view, options, *scene);
    if (!rays) return false;
    placedLights = engine::placedLights(scene->scene(), view);
    strata = strataOf(*scene, options);
    portals.reset();
    camera = *rays;
    filmView = view;
    filmOptions = options;
    filmSeed = options.seed;
    filmCentred = centred;
    progress.integrator = integratorOf(options, scene->traits());
    filmScene = scene;
    return true;
}

/// Lets the rule bring the scene and the view to the moment of a pass. The image goes on.
void SessionState::takePose(const StopRule& rule, int pass)
{
    if (!rule.pose) return;
    OSGRAYTRACE_ASSERT(filmOptions.moving);
    rule.pose(pass);
    const std::optional<CameraRays> rays = scene ? raysOf(view, filmOptions, *scene) : std::nullopt;
    if (!rays || view.width != filmView.width || view.height != filmView.height)
        throw EngineError(StatusCode::InvalidView, "the view cannot be seen at a moment of a pass");
    camera = *rays;
    placedLights = engine::placedLights(scene->scene(), view);
    strata = strataOf(*scene, filmOptions);
    filmScene = scene;
    filmView = view;
}

/// Clears the film for the wanted view. If the view continues, tiles without a pass have the depths
/// and the surfaces that they had, and grow older. sums: what the film begins with; null: nothing.
void SessionState::resetFilm(bool continues, const PassSums* sums)
{
    if (continues)
        for (int tile = 0; tile < film.tileCount(); ++tile)
        {
            uint16_t& age = tileAges[static_cast<std::size_t>(tile)];
            age = film.tilePasses(tile) > 0 ? 0 : static_cast<uint16_t>(std::min(age + 1, 0xffff));
        }
    film.reset(view.width, view.height, sumsKind);
    filmPasses = PassSet();
    wantedPass.reset();
    filmFirstPass = firstPass;
    tracedPasses = ownPasses = 0;
    learntPasses.clear();
    if (sums)
    {
        setFilm(*sums, film);
        filmPasses = sums->passes;
    }
    surfaces.finished = false;
    filmContinues = continues;
    if (continues)
        film.holdDepths();
    else
        tileAges.assign(static_cast<std::size_t>(film.tileCount()), 0);
}

PassContext SessionState::contextOfPass(int pass) const
{
    PassContext context;
    context.traced = filmScene.get();
    context.lights = placedLights.empty() ? &filmScene->scene().lights : &placedLights;
    context.strata = strata.empty() ? nullptr : &strata;
    context.camera = camera;
    context.width = filmView.width;
    context.height = filmView.height;
    context.eye = eyeOf(filmView, filmScene->scene());
    context.eyeFromEngine = eyeFromEngine(filmView);
    context.towardsViewer = glm::transpose(context.eyeFromEngine)[2];
    context.options = filmOptions;
    context.options.integrator = progress.integrator;
    if (filmOptions.moving) context.options.photonGuiding = false; // what photons lit is gone
    context.key = passKey(filmSeed, pass);
    const bool sharesPaths = progress.integrator == IntegratorKind::Ppm &&
                             !filmScene->traits().media &&
                             !filmScene->traits().subsurface; // see PhotonState::choose
    const int paths = sharesPaths ? sharedPaths(pass) : pass;
    context.pathKey = passKey(filmSeed, paths);
    context.coneScale = 1.0f / std::sqrt(static_cast<float>(paths + 1));
    context.wantsDepth = pass == 0;
    context.throughCentres = filmCentred || (filmOptions.centredFirstPass && paths == 0);
    return context;
}

/// Lets the pass know the openings to the sky. They are looked for when the first pass wants them:
/// views that move, whose images have few passes, pay nothing for them.
void SessionState::preparePortals(PassContext& context, int pass)
{
    const int firstPass = filmOptions.still ? 0 : 2; // that knows them
    const SceneTraits& traits = context.traced->traits();
    const bool wanted = pass >= firstPass && progress.integrator == IntegratorKind::Path &&
                        context.photonUse == PhotonUse::None &&
                        context.traced->lights().shiningEnvironment() && !context.strata &&
                        !traits.media && context.options.shadows && !filmOptions.moving;
    if (!wanted) return;
    if (!portals)
    {
        TileCounts counts;
        portals = findSkyPortals(context, counts);
        progress.rays.camera += counts.cameraRays;
        progress.rays.shadow += counts.shadowRays;
        progress.rays.secondary += counts.secondaryRays;
    }
    context.portals = portals->get();
}

/// Returns the context of the pass that is made next. The depths of an image are those of the least
/// of its passes, in whatever order these are made.
PassContext SessionState::contextOf(const NextPass& pass) const
{
    PassContext context = contextOfPass(pass.number);
    const bool first = filmPasses.empty() || pass.number < filmPasses.ranges().front().first;
    context.wantsDepth = first && !pass.isLearning;
    return context;
}

} // namespace osgRayTrace::engine
