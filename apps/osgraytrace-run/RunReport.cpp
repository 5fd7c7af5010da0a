// RunReport.cpp - keeps the statistics of scenes until the process exits. Layer: apps.
// SPDX-License-Identifier: MIT
#include "RunReport.h"

#include "osgRayTrace/base/NeverDestroyed.h"

#include <osgRayTrace/Statistics>

#include <osg/Notify>

#include <cstdlib>
#include <fstream>
#include <mutex>
#include <vector>

namespace osgRayTrace::app
{

namespace
{

/// The drawables hold the statistics, and outlive their scenes.
struct Drawables
{
    std::mutex mutex;
    std::vector<osg::ref_ptr<RayTraceDrawable>> list; // guarded by mutex
};

Drawables& drawables()
{
    static engine::NeverDestroyed<Drawables> drawables;
    return *drawables;
}

const char* file()
{
    const char* name = std::getenv("OSGRAYTRACE_RUN_REPORT");
    return name && *name ? name : nullptr;
}

void writeReport()
{
    const char* name = file();
    if (!name) return;
    const std::lock_guard<std::mutex> lock(drawables().mutex);
    std::ofstream report(name);
    for (const osg::ref_ptr<RayTraceDrawable>& drawable : drawables().list)
        report << conversionReport(drawable->getStatistics());
    if (!report.flush())
        OSG_WARN << "osgRayTrace: the report cannot be written to " << name << std::endl;
}

} // namespace

void reportAtExit(RayTracedScene& scene)
{
    if (!file()) return;
    const std::lock_guard<std::mutex> lock(drawables().mutex);
    if (drawables().list.empty()) std::atexit(writeReport);
    drawables().list.emplace_back(scene.getDrawable());
}

} // namespace osgRayTrace::app
