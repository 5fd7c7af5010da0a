// PhotonErrors.cpp - renders by photons and paths, and compares. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/common/Failure.h"
#include "apps/common/PluginPath.h"
#include "apps/osgraytracebench/photons/PhotonsMode.h"
#include "apps/osgraytracebench/report/BoxScenes.h"
#include "apps/osgraytracebench/report/Measurement.h"
#include "apps/osgraytracebench/report/PreparedScene.h"
#include "apps/osgraytracebench/report/Reference.h"
#include "apps/osgraytracebench/report/Slopes.h"
#include "osgRayTrace/base/Parallel.h"

#include <osgDB/ReadFile>

#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr int kEdges = 100; ///< most edges of a path, as in measurements of other renderers

std::vector<Method> methods()
{
    std::vector<Method> list{pathMethod(kEdges)};
    const std::pair<const char*, IntegratorKind> photons[] = {
        {"PPM", IntegratorKind::Ppm},
        {"SPPM", IntegratorKind::Sppm},
        {"PHOTON_CAUSTICS", IntegratorKind::PhotonCaustics}};
    list[0].name = "PATH";
    for (const auto& [name, kind] : photons)
    {
        Method method{name, list[0].options};
        method.options.integrator = kind;
        list.push_back(method);
    }
    return list;
}

/// Returns a reference from a picture of linear RGB, which is taken for exact.
Reference storedReference(const std::string& file, int width, int height)
{
    app::addPluginPath();
    const osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(file);
    if (!image || image->getDataType() != GL_FLOAT)
        throw app::Failure(app::kCannotLoad, "cannot load " + file + " as a picture of floats");
    if (image->s() != width || image->t() != height)
        throw app::Failure(app::kCannotLoad,
                           file + " is not " + std::to_string(width) + " pixels wide and high");
    Reference reference;
    reference.width = width;
    reference.height = height;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
        {
            const osg::Vec4 color = image->getColor(x, y);
            reference.mean.insert(reference.mean.end(), {color.r(), color.g(), color.b()});
        }
    reference.variance.assign(reference.mean.size(), 0.0);
    reference.origin = file;
    finish(reference);
    return reference;
}

void measureScene(char letter, CornellKind kind, const std::string& file,
                  const PhotonsOptions& options, Rows& rows)
{
    const ReportScene scene = cornellScene(kind);
    const PreparedScene prepared =
        prepare(scene, atOrigin(), options.width, std::make_shared<Workers>());
    const Reference reference =
        file.empty() ? newReference(scene, prepared, {8, 0, options.referenceSeconds / 8})
                     : storedReference(file, options.width, options.width);
    const std::string stem = std::string("error ") + letter + " ";
    if (file.empty())
        rows.push_back(
            {stem + "reference: its noise, taken off below", noiseOf(reference, 0.1), "relMSE"});
    BudgetPlan plan = timedPlan(options.longest);
    plan.seeds.assign(plan.seeds.size(), options.seeds);
    for (const Method& method : methods())
    {
        const MeasuredLine measured = measure(scene, atOrigin(), method, prepared, reference, plan);
        std::vector<double> seconds, errors;
        for (const ReportRow& row : measured.line.rows)
        {
            seconds.push_back(row.seconds);
            errors.push_back(row.relMseFixed);
            char text[32];
            std::snprintf(text, sizeof text, "%.3g s", row.seconds);
            rows.push_back({stem + method.name + " after " + text, row.relMseFixed, "relMSE"});
        }
        for (const double target : {1e-2, 3e-3})
        {
            const std::optional<double> reached = crossing(seconds, errors, target);
            char text[48];
            std::snprintf(text, sizeof text, "%s to relMSE %.0e", method.name.c_str(), target);
            const bool atOnce = !errors.empty() && errors.front() <= target;
            rows.push_back({stem + text,
                            reached  ? *reached
                            : atOnce ? seconds.front()
                                     : std::numeric_limits<double>::infinity(),
                            atOnce ? "s or less" : "s"});
        }
    }
}

} // namespace

void measurePhotonErrors(const PhotonsOptions& options, Rows& rows)
{
    measureScene('a', CornellKind::Diffuse, options.referenceA, options, rows);
    measureScene('b', CornellKind::Mirror, options.referenceB, options, rows);
    measureScene('c', CornellKind::Glass, options.referenceC, options, rows);
}

} // namespace osgRayTrace::bench
