// UpdateMode.cpp - what an edit of a large live scene costs. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/UpdateMode.h"

#include "apps/osgraytracebench/ObjectField.h"
#include "apps/osgraytracebench/ResidentBytes.h"
#include "apps/osgraytracebench/Timing.h"
#include "osgRayTrace/bridge/SceneUpdater.h"

#include <string>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr int kRuns = 21;
constexpr unsigned int kDeformedStep = 100; // 1 %

/// An updater on one thread; update() is what a frame does.
class LiveScene
{
public:
    explicit LiveScene(osg::Node* root) : _root(root)
    {
        _settings->setThreads(1);
        _updater.noteView(this, nullptr, ViewingConditions());
        update();
    }

    void update() { _updater.update(_root, *_settings, nullptr); }
    Statistics statistics() const { return _updater.statistics(); }

private:
    osg::Node* _root;
    osg::ref_ptr<RayTraceSettings> _settings = new RayTraceSettings;
    SceneUpdater _updater;
};

double medianSeconds(const std::function<void()>& body)
{
    body();
    std::vector<double> seconds;
    for (int i = 0; i < kRuns; ++i)
        seconds.push_back(threadSecondsOf(body));
    return median(seconds);
}

void addPair(Rows& rows, const std::string& what, const std::string& yardstick,
             const PairedTimes& times, double goal)
{
    rows.push_back({what, times.first * 1e3, "ms"});
    rows.push_back({what + ": " + yardstick, times.second * 1e3, "ms"});
    rows.push_back({what + " / " + yardstick, times.ratio, "times", Goal::AtMost, goal});
}

void measureEdits(Rows& rows)
{
    ObjectField field(false);
    LiveScene live(field.root.get());
    rows.push_back({"first conversion", live.statistics().convertSeconds * 1e3, "ms"});
    rows.push_back({"first build", live.statistics().buildSeconds * 1e3, "ms"});

    const double walk = medianSeconds([&] { live.update(); });
    rows.push_back(
        {"unchanged walk", walk * 1e3 * 1e4 / field.nodes(), "ms/10,000 nodes", Goal::AtMost, 1.0});

    // Everything moves once: then all objects are instances, as they are in the yardstick.
    for (unsigned int i = 0; i < field.count(); ++i)
        field.transforms[i]->setMatrix(field.place(i, 0.01));
    rows.push_back(
        {"all moved for the first time", 1e3 * threadSecondsOf([&] { live.update(); }), "ms"});

    const Workers one(1);
    BareField bare(field);
    int turn = 0;
    const auto height = [&turn] { return 0.001 * (++turn % 100); };
    addPair(rows, "one moved transform", "Embree's top-level commit",
            timePair(
                kRuns,
                [&]
                {
                    field.transforms[5000]->setMatrix(field.place(5000, height()));
                    live.update();
                },
                [&] { one.run([&] { bare.move(5000, field.place(5000, height())); }); },
                threadSecondsOf),
            2.0);

    // The application's own work is not in the times.
    const auto deformField = [&]
    {
        const double phase = 10.0 * height();
        for (unsigned int i = 0; i < field.count(); i += kDeformedStep)
            field.deform(i, phase);
    };
    const auto timeDeformed = [&](const std::function<void()>& body)
    {
        deformField();
        return threadSecondsOf(body);
    };
    const auto updateField = [&] { live.update(); };
    const auto refitField = [&] { one.run([&] { bare.deform(field, 0, kDeformedStep); }); };
    for (int i = 0; i < 3; ++i) // the meshes that deform leave the others, and get their copies
        timeDeformed(updateField);
    std::vector<double> ours, embrees, ratios;
    const uint64_t refitsBefore = live.statistics().refitMeshes;
    for (int i = 0; i < kRuns; ++i)
    {
        ours.push_back(timeDeformed(updateField));
        embrees.push_back(timeDeformed(refitField));
        live.update();
        ratios.push_back(ours.back() / embrees.back());
    }
    addPair(rows, "1 % of the meshes deformed", "Embree's refit and commit",
            {median(ours), median(embrees), median(ratios)}, 1.5);
    rows.push_back({"1 % of the meshes deformed: refits a frame",
                    double(live.statistics().refitMeshes - refitsBefore) / (2 * kRuns), ""});

    const Statistics before = live.statistics();
    const double edit = medianSeconds(
        [&]
        {
            field.materials[7]->setDiffuse(osg::Material::FRONT_AND_BACK,
                                           osg::Vec4(float(height()), 0.0f, 0.0f, 1.0f));
            live.update();
        });
    const Statistics after = live.statistics();
    rows.push_back({"a material edited", edit * 1e3, "ms"});
    rows.push_back({"a material edited: commits of Embree",
                    double(after.embreeCommits - before.embreeCommits), "", Goal::AtMost, 0.0});
}

double instanceBytes(unsigned int count)
{
    const ObjectField field(true, count);
    const double before = residentBytes();
    const LiveScene live(field.root.get());
    return residentBytes() - before;
}

void measureInstances(Rows& rows)
{
    instanceBytes(2); // what the process needs once
    const double few = instanceBytes(2), many = instanceBytes(kFieldObjects);
    rows.push_back({"10,000 instances of one mesh: beyond the mesh's own",
                    (many - few) / kFieldObjects, "bytes/instance", Goal::AtMost, 400.0});
}

} // namespace

Rows measureUpdate()
{
    Rows rows;
    measureInstances(rows);
    measureEdits(rows);
    return rows;
}

} // namespace osgRayTrace::bench
