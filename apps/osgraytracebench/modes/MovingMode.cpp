// MovingMode.cpp - compares frames of moving views with converged pictures. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/MovingMode.h"

#include "apps/common/ImageFile.h"
#include "apps/osgraytracebench/Timing.h"
#include "apps/osgraytracebench/report/Ssim.h"
#include "apps/osgraytracebench/scenes/MovingScenes.h"
#include "osgRayTrace/bridge/common/PixelImage.h"
#include "osgRayTrace/bridge/common/ViewFromMatrices.h"
#include "osgRayTrace/bridge/update/SceneUpdater.h"
#include "osgRayTrace/film/Enlarge.h"
#include "osgRayTrace/session/upsample/Upsample.h"
#include "osgRayTrace/session/view/ViewTracer.h"

#include <osg/Light>
#include <osgDB/FileNameUtils>
#include <osgDB/ReadFile>

#include <cstring>
#include <functional>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr int kRuns = 5;

using Clock = std::function<double()>;

double cpuSeconds()
{
    timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

Clock clockOf(const MovingOptions& options)
{
    if (!options.cpuClock) return {};
    return [threads = options.threads] { return cpuSeconds() / threads; };
}

/// Display values and window depths.
struct Picture
{
    int width = 0, height = 0;
    std::vector<uint8_t> rgba;
    std::vector<float> depth;

    void resize(int w, int h)
    {
        width = w;
        height = h;
        rgba.resize(4 * std::size_t(w) * std::size_t(h));
        depth.resize(std::size_t(w) * std::size_t(h));
    }
};

/// A scene that moves, or that is seen from a place that moves. Its function scene sets what there
/// is at a time [s], and matrix returns from where it is seen.
struct Subject
{
    std::string name;
    osg::ref_ptr<osg::Node> root;
    std::function<void(double)> move;
    std::function<osg::Matrixd(double)> matrix;
    double nearPlane, farPlane;
};

osg::ref_ptr<osg::Light> newHeadlight()
{
    osg::ref_ptr<osg::Light> light = new osg::Light;
    light->setDiffuse(osg::Vec4(0.6f, 0.6f, 0.6f, 1.0f));
    light->setAmbient(osg::Vec4());
    return light;
}

/// Converts the subject as a viewer does, with osgViewer's light at the eye.
class Stage
{
public:
    Stage(const Subject& subject, const MovingOptions& options)
        : _subject(subject), _options(options), _workers(std::make_shared<Workers>(options.threads))
    {
        ViewingConditions conditions;
        conditions.light = _light;
        _updater.recordView(nullptr, nullptr, conditions);
    }

    /// Returns the inputs of a frame.
    ViewInputs inputs(double time)
    {
        _subject.move(time);
        _updater.update(_subject.root, *_settings, nullptr);
        ViewInputs inputs = _updater.version().inputs;
        inputs.workers = _workers;
        inputs.options.integrator = _options.integrator;
        return inputs;
    }

    View view(double time) const
    {
        const osg::Matrixd projection = osg::Matrixd::perspective(
            40.0, double(_options.width) / _options.height, _subject.nearPlane, _subject.farPlane);
        return viewFromMatrices(_subject.matrix(time), projection, _options.width, _options.height);
    }

private:
    const Subject& _subject;
    const MovingOptions& _options;
    std::shared_ptr<Workers> _workers;
    osg::ref_ptr<osg::Light> _light = newHeadlight();
    osg::ref_ptr<RayTraceSettings> _settings = new RayTraceSettings;
    SceneUpdater _updater;
};

/// Returns a picture as OpenGL shows it: enlarged linearly, over the colour of the window.
std::vector<uint8_t> shownOn(const Picture& picture, const View& view)
{
    osg::ref_ptr<osg::Image> image =
        newPixelImage(view.width, view.height, GL_RGBA, GL_UNSIGNED_BYTE);
    std::vector<float> depth(std::size_t(view.width) * std::size_t(view.height));
    enlarge({picture.width, picture.height, const_cast<uint8_t*>(picture.rgba.data()),
             const_cast<float*>(picture.depth.data())},
            {view.width, view.height, image->data(), depth.data()}, Workers(1));
    blendOver(*image, osg::Vec4(0.2f, 0.2f, 0.4f, 1.0f));
    return {image->data(), image->data() + image->getTotalSizeInBytes()};
}

void writePicture(const MovingOptions& options, const std::string& name,
                  const std::vector<uint8_t>& rgba)
{
    if (options.pictures.empty()) return;
    osg::ref_ptr<osg::Image> image =
        newPixelImage(options.width, options.height, GL_RGBA, GL_UNSIGNED_BYTE);
    std::memcpy(image->data(), rgba.data(), rgba.size());
    app::writeImageFile(options.pictures + "/" + name + ".png", *image);
}

/// Returns the image of a session after so many passes at the divider, and what they took over the
/// threads [s].
double renderPasses(RenderSession& session, const ViewInputs& inputs, const View& view, int divider,
                    int passes)
{
    RenderOptions options = inputs.options;
    options.centredFirstPass = divider > 1;
    session.setCentred(divider > 1);
    session.setScene(inputs.scene);
    session.setView(reducedView(view, divider));
    session.setOptions(options);
    StopRule rule;
    rule.passes = passes;
    const double begin = cpuSeconds();
    session.render(rule);
    return (cpuSeconds() - begin) / inputs.workers->threads();
}

std::vector<uint8_t> convergedPicture(const MovingOptions& options, const ViewInputs& inputs,
                                      const View& view)
{
    RenderSession session(inputs.workers);
    renderPasses(session, inputs, view, 1, options.references);
    Picture picture;
    picture.resize(view.width, view.height);
    session.resolveDisplay(toneMapOf(inputs), picture.rgba.data(), picture.depth.data());
    return shownOn(picture, view);
}

/// Compares images of fixed dividers with the converged picture.
void addDividers(Rows& rows, const MovingOptions& options, const std::string& name,
                 const ViewInputs& inputs, const View& view, const std::vector<uint8_t>& converged)
{
    for (const int divider : {1, 2, 4, 8, 16})
    {
        const std::string label = name + ", 1/" + std::to_string(divider);
        const auto addSsim = [&](const std::string& what, const Picture& picture)
        {
            const std::vector<uint8_t> shown = shownOn(picture, view);
            rows.push_back({label + ": SSIM " + what,
                            meanSsim(shown, converged, view.width, view.height), ""});
            writePicture(options, name + "-" + what + "-" + std::to_string(divider), shown);
        };
        RenderSession session(inputs.workers);
        std::vector<double> passes;
        for (int i = 0; i < kRuns; ++i)
        {
            session.clear();
            passes.push_back(renderPasses(session, inputs, view, divider, 1));
        }
        rows.push_back({label + ": a pass", 1e3 * median(passes), "ms"});
        const ToneMap toneMap = toneMapOf(inputs);
        Picture picture;
        picture.resize(session.width(), session.height());
        session.resolveDisplay(toneMap, picture.rgba.data(), picture.depth.data());
        addSsim("linear", picture);
        if (divider == 1) continue;
        picture.resize(view.width, view.height);
        for (const bool all : {false, true})
        {
            const std::string what = all ? "all" : "edges";
            UpsampleCounts counts;
            std::vector<double> seconds;
            for (int i = 0; i < kRuns; ++i)
            {
                const double begin = cpuSeconds();
                counts = session.presentUpsampled(
                    session.resolvedImage(), session.surfaceSamples(), view.width, view.height,
                    {toneMap, picture.rgba.data(), picture.depth.data()}, all ? kAllTraced : 1.0);
                seconds.push_back((cpuSeconds() - begin) / options.threads);
            }
            addSsim(what, picture);
            rows.push_back({label + ": made large, " + what, 1e3 * median(seconds), "ms"});
            const double share = double(counts.traced) / (double(view.width) * view.height);
            rows.push_back({label + ": pixels traced, " + what, 100.0 * share, "%"});
        }
    }
}

void measureSubject(Rows& rows, const MovingOptions& options, const Subject& subject)
{
    if (subject.name.find(options.only) == std::string::npos) return;
    Stage stage(subject, options);
    ViewTracer tracer(clockOf(options));
    Picture picture;
    std::vector<double> trace, present, whole, dividers;
    ViewInputs inputs;
    View view;
    FrameBudget budget;
    budget.seconds = 1e-3 * options.budget;
    for (int frame = 0; frame < options.frames; ++frame)
    {
        inputs = stage.inputs(frame / 30.0);
        view = stage.view(frame / 30.0);
        const bool fits = picture.width == view.width && picture.height == view.height;
        tracer.trace(inputs, view, budget, fits ? picture.rgba.data() : nullptr,
                     fits ? picture.depth.data() : nullptr);
        if (tracer.needsResolve(inputs))
        {
            picture.resize(tracer.displayWidth(), tracer.displayHeight());
            tracer.resolve(picture.rgba.data(), picture.depth.data());
        }
        tracer.recordPresented();
        endIfInterrupted();
        if (2 * frame < options.frames) continue;
        trace.push_back(tracer.frame().traceSeconds);
        whole.push_back(tracer.frame().seconds);
        present.push_back(whole.back() - trace.back());
        dividers.push_back(tracer.frame().divider);
    }
    const std::vector<uint8_t> converged = convergedPicture(options, inputs, view);
    const std::vector<uint8_t> shown = shownOn(picture, view);
    const std::string& name = subject.name;
    writePicture(options, name + "-converged", converged);
    writePicture(options, name + "-moving", shown);
    rows.push_back({name + ": SSIM of a frame", meanSsim(shown, converged, view.width, view.height),
                    "", Goal::AtLeast, 0.9});
    rows.push_back({name + ": divider", median(dividers), ""});
    rows.push_back({name + ": width shown", double(picture.width), "pixels"});
    rows.push_back({name + ": tracing", 1e3 * median(trace), "ms"});
    rows.push_back({name + ": presenting", 1e3 * median(present), "ms"});
    std::sort(whole.begin(), whole.end());
    rows.push_back({name + ": frame", 1e3 * median(whole), "ms"});
    rows.push_back({name + ": frame, 90th percentile", 1e3 * whole[whole.size() * 9 / 10], "ms"});
    addDividers(rows, options, name, inputs, view, converged);
}

/// Returns a view of a model from an orbit above it.
Subject orbited(const std::string& name, osg::Node* model)
{
    const osg::BoundingSphere bound = model->getBound();
    const auto matrix = [bound](double time)
    {
        const osg::Vec3d from(0.8 * std::cos(0.5 * time - 1.2), 0.8 * std::sin(0.5 * time - 1.2),
                              0.6);
        const osg::Vec3d centre(bound.center());
        return osg::Matrixd::lookAt(centre + from * (1.7 * bound.radius()), centre,
                                    osg::Vec3d(0.0, 0.0, 1.0));
    };
    return {name, model, [](double) {}, matrix, 0.05 * bound.radius(), 10.0 * bound.radius()};
}

} // namespace

void measureMoving(const MovingOptions& options, Rows& rows)
{
    const osg::Vec3d up(0.0, 0.0, 1.0);
    const auto flight = [up](double time)
    {
        const osg::Vec3d eye(500.0 + 30.0 * time, 300.0, 330.0);
        return osg::Matrixd::lookAt(eye, eye + osg::Vec3d(0.5, 1.0, -0.35), up);
    };
    measureSubject(rows, options,
                   {"terrain", texturedTerrain(), [](double) {}, flight, 5.0, 4000.0});
    Traffic traffic;
    const auto above = [up](double)
    { return osg::Matrixd::lookAt(osg::Vec3d(60, 40, 45), osg::Vec3d(120, 130, 0), up); };
    measureSubject(
        rows, options,
        {"traffic", traffic.root, [&](double time) { traffic.move(time); }, above, 2.0, 1000.0});
    for (const std::string& file : options.models)
    {
        const osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(file);
        if (model) measureSubject(rows, options, orbited(osgDB::getStrippedName(file), model));
    }
}

} // namespace osgRayTrace::bench
