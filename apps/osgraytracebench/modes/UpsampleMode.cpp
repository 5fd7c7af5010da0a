// UpsampleMode.cpp - renders subjects at reduced sizes and compares them. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/UpsampleMode.h"

#include "apps/common/ImageFile.h"
#include "apps/osgraytracebench/Timing.h"
#include "apps/osgraytracebench/scenes/BenchScenes.h"
#include "apps/osgraytracebench/scenes/ObjectField.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/bridge/common/PixelImage.h"
#include "osgRayTrace/bridge/common/ViewFromMatrices.h"
#include "osgRayTrace/bridge/update/SceneUpdater.h"
#include "osgRayTrace/session/RenderSession.h"

#include <osg/Light>
#include <osgDB/FileNameUtils>
#include <osgDB/ReadFile>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr int kWidth = 1920, kHeight = 1080;
constexpr int kRuns = 5;
constexpr double kMostTraced = 0.25; // limit of the rows that have one

struct Subject
{
    std::string name;
    std::shared_ptr<const TracedScene> scene;
    View view;
};

/// Returns a subject seen from above at a distance in radii of its bound, with osgViewer's light at
/// the eye.
Subject subjectOf(const std::string& name, osg::Node* content, double distance)
{
    osg::ref_ptr<osg::Light> light = new osg::Light;
    ViewingConditions conditions;
    conditions.light = light;
    const osg::BoundingSphere& bound = content->getBound();
    osg::Vec3d from(0.4, -1.0, 0.6);
    from.normalize();
    const osg::Vec3d centre(bound.center());
    const osg::Matrixd looking = osg::Matrixd::lookAt(centre + from * (distance * bound.radius()),
                                                      centre, osg::Vec3d(0.0, 0.0, 1.0));
    const osg::Matrixd projection = osg::Matrixd::perspective(
        30.0, double(kWidth) / kHeight, 0.02 * bound.radius(), 5.0 * bound.radius());
    const View view = viewFromMatrices(looking, projection, kWidth, kHeight);
    SceneUpdater updater;
    osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
    updater.recordView(nullptr, nullptr, conditions);
    updater.update(content, *settings, nullptr);
    return {name, updater.version().inputs.scene, view};
}

View reducedView(View view, int divider)
{
    view.width = (kWidth + divider - 1) / divider;
    view.height = (kHeight + divider - 1) / divider;
    return view;
}

/// Renders so many passes, each with as little noise as the options allow.
void renderTo(RenderSession& session, const Subject& subject, int divider, int passes)
{
    RenderOptions options;
    options.integrator = IntegratorKind::Whitted;
    options.lightSamples = divider == 1 ? 4 : 64;
    options.centredFirstPass = divider > 1;
    session.setScene(subject.scene);
    session.setView(reducedView(subject.view, divider));
    session.setOptions(options);
    StopRule rule;
    rule.passes = passes;
    session.render(rule);
}

/// Renders one pass to the display of its size: a picture of full size as without upsampling, a
/// smaller one with the surfaces of first hits.
void renderOnce(const std::shared_ptr<Workers>& workers, const Subject& subject, int divider)
{
    static std::vector<uint8_t> rgba(4 * std::size_t(kWidth) * kHeight);
    static std::vector<float> depth(std::size_t(kWidth) * kHeight);
    RenderSession session(workers);
    session.setScene(subject.scene);
    session.setView(reducedView(subject.view, divider));
    RenderOptions options;
    options.integrator = IntegratorKind::Whitted;
    options.centredFirstPass = divider > 1;
    session.setOptions(options);
    StopRule rule;
    rule.passes = 1;
    const DisplayTarget display{{}, rgba.data(), depth.data()};
    session.render(rule, {}, &display);
}

/// Returns the relMSE of linear RGB.
double errorOf(const ResolvedImage& image, const ResolvedImage& reference)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < reference.radiance.size(); ++i)
    {
        if (i % 4 == 3) continue;
        const double r = reference.radiance[i], d = image.radiance[i] - r;
        sum += d * d / (r * r + 0.01);
    }
    return sum / (0.75 * static_cast<double>(reference.radiance.size()));
}

/// Returns the image enlarged as blocks, or linearly between pixels.
ResolvedImage enlarged(const ResolvedImage& image, bool linear)
{
    ResolvedImage result;
    result.width = kWidth;
    result.height = kHeight;
    result.radiance.resize(4 * std::size_t(kWidth) * kHeight);
    const auto at = [&](int x, int y, int c)
    {
        x = std::clamp(x, 0, image.width - 1);
        y = std::clamp(y, 0, image.height - 1);
        return image.radiance[4 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) +
                              std::size_t(c)];
    };
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
        {
            const float u = (float(x) + 0.5f) * float(image.width) / kWidth - 0.5f;
            const float v = (float(y) + 0.5f) * float(image.height) / kHeight - 0.5f;
            const int i = int(std::floor(u)), j = int(std::floor(v));
            float s = u - float(i), t = v - float(j);
            if (!linear)
            {
                s = std::round(s);
                t = std::round(t);
            }
            for (int c = 0; c < 4; ++c)
                result.radiance[4 * (std::size_t(y) * kWidth + std::size_t(x)) + std::size_t(c)] =
                    (1 - t) * ((1 - s) * at(i, j, c) + s * at(i + 1, j, c)) +
                    t * ((1 - s) * at(i, j + 1, c) + s * at(i + 1, j + 1, c));
        }
    return result;
}

void writePicture(const ResolvedImage& image, const std::string& folder, std::string name)
{
    if (folder.empty()) return;
    std::replace(name.begin(), name.end(), ' ', '-');
    std::replace(name.begin(), name.end(), ',', '_');
    osg::ref_ptr<osg::Image> pixels =
        newPixelImage(image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE);
    ResolvedImage shown = image;
    presentImage(shown, {}, Workers(), pixels->data(), nullptr);
    blendOver(*pixels, osg::Vec4(0.2f, 0.2f, 0.4f, 1.0f));
    app::writeImageFile(folder + "/" + name + ".png", *pixels);
}

double milliseconds(const std::function<void()>& body)
{
    std::vector<double> seconds;
    for (int i = 0; i < kRuns; ++i)
        seconds.push_back(threadSecondsOf(body));
    return 1e3 * median(seconds);
}

/// An image of fewer pixels, and the session that made it.
struct SmallImage
{
    SmallImage(const std::shared_ptr<Workers>& workers, const Subject& subject, int part)
        : session(workers), name(subject.name + ", 1/" + std::to_string(part)), divider(part)
    {
        renderTo(session, subject, part, 1);
        image = session.resolvedImage();
    }
    const std::vector<SurfaceSample>& samples() const { return session.surfaceSamples(); }
    /// The name of a picture's file.
    std::string pictureOf(const std::string& way) const
    {
        return name.substr(0, name.size() - 2) + " " + way + " " + name.back();
    }

    RenderSession session;
    std::string name;
    int divider;
    ResolvedImage image;
};

/// Measures what the image loses when it is made into one of the full size in several ways.
void measureErrors(Rows& rows, const SmallImage& small, const ResolvedImage& reference,
                   const std::string& pictures)
{
    const std::string& name = small.name;
    ResolvedImage result;
    const UpsampleCounts counts =
        small.session.upsample(small.image, small.samples(), kWidth, kHeight, result);
    const ResolvedImage blocks = enlarged(small.image, false), linear = enlarged(small.image, true);
    writePicture(blocks, pictures, small.pictureOf("blocks"));
    writePicture(linear, pictures, small.pictureOf("linear"));
    writePicture(result, pictures, small.pictureOf("edges"));
    const double blockError = errorOf(blocks, reference), linearError = errorOf(linear, reference),
                 error = errorOf(result, reference);
    rows.push_back({name + ": relMSE of blocks", blockError, ""});
    rows.push_back({name + ": relMSE linear", linearError, ""});
    rows.push_back({name + ": relMSE along edges", error, ""});
    rows.push_back({name + ": blocks / along edges", blockError / error, "times"});
    rows.push_back({name + ": linear / along edges", linearError / error, "times"});
    ResolvedImage limited;
    small.session.upsample(small.image, small.samples(), kWidth, kHeight, limited, kMostTraced);
    writePicture(limited, pictures, small.pictureOf("limited"));
    rows.push_back({name + ": relMSE along edges, limited", errorOf(limited, reference), ""});
    const double pixels = double(kWidth) * kHeight;
    rows.push_back({name + ": pixels traced", 100.0 * double(counts.traced) / pixels, "%"});
    rows.push_back(
        {name + ": of them without a like", 100.0 * double(counts.unlike) / pixels, "%"});
}

/// Measures what it costs to trace and to present the image.
void measureCosts(Rows& rows, const SmallImage& small, const Subject& subject,
                  const std::shared_ptr<Workers>& one)
{
    const std::string& name = small.name;
    const RenderSession& session = small.session;
    std::vector<uint8_t> rgba(4 * std::size_t(kWidth) * kHeight);
    std::vector<float> depth(std::size_t(kWidth) * kHeight);
    const DisplayTarget display{{}, rgba.data(), depth.data()};
    ResolvedImage result;
    const auto addMilliseconds = [&](const char* what, const std::function<void()>& body) {
        rows.push_back({name + ": " + what, milliseconds(body), "ms"});
    };
    addMilliseconds("shownImage", [&] { session.resolvedImage(); });
    addMilliseconds("a pass of the small image", [&] { renderOnce(one, subject, small.divider); });
    addMilliseconds(
        "showUpsampled",
        [&] { session.presentUpsampled(small.image, small.samples(), kWidth, kHeight, display); });
    addMilliseconds("upsample alone", [&]
                    { session.upsample(small.image, small.samples(), kWidth, kHeight, result); });
    addMilliseconds("showUpsampled, limited",
                    [&] {
                        session.presentUpsampled(small.image, small.samples(), kWidth, kHeight,
                                                 display, kMostTraced);
                    });
    addMilliseconds("a whole pass of the full size", [&] { renderOnce(one, subject, 1); });
    addMilliseconds("showImage of the full size",
                    [&] { presentImage(result, {}, *one, rgba.data(), depth.data()); });
}

void measure(Rows& rows, const Subject& subject, const std::string& pictures)
{
    const auto one = std::make_shared<Workers>(1);
    RenderSession full(std::make_shared<Workers>());
    renderTo(full, subject, 1, 16);
    const ResolvedImage reference = full.resolvedImage();
    writePicture(reference, pictures, subject.name + " full");
    for (const int divider : {2, 4})
    {
        const SmallImage small(one, subject, divider);
        measureErrors(rows, small, reference, pictures);
        measureCosts(rows, small, subject, one);
    }
}

} // namespace

void measureUpsampling(const std::vector<std::string>& models, const std::string& pictures,
                       Rows& rows)
{
    const auto workers = std::make_shared<Workers>();
    const BenchScene box = cornellBox(kWidth, kHeight);
    measure(rows, {"Cornell box", TracedScene::build(box.scene, workers), box.view}, pictures);
    const ObjectField field(true);
    measure(rows, subjectOf("10,000 objects", field.root.get(), 1.2), pictures);
    for (const std::string& file : models)
    {
        const osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(file);
        if (model)
            measure(rows, subjectOf(osgDB::getStrippedName(file), model.get(), 2.0), pictures);
    }
}

} // namespace osgRayTrace::bench
