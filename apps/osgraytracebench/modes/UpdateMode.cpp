// UpdateMode.cpp - edits of a live scene against Embree's own work. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/UpdateMode.h"

#include "apps/osgraytracebench/ResidentBytes.h"
#include "apps/osgraytracebench/Timing.h"
#include "apps/osgraytracebench/modes/InstanceRays.h"
#include "apps/osgraytracebench/modes/LiveScene.h"
#include "apps/osgraytracebench/modes/SmallEdits.h"
#include "apps/osgraytracebench/modes/WatchRows.h"
#include "apps/osgraytracebench/scenes/ObjectField.h"
#include "osgRayTrace/base/Parallel.h"

#include <string>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr unsigned int kDeformedStep = 100; // every 100th object: 1 %

/// One per cent of the meshes deforms.
void measureDeformed(Rows& rows, ObjectField& field, LiveScene& live, BareField& bare)
{
    const Workers one(1);
    int turn = 0;
    // The application's own work is not in the times.
    const auto deformField = [&]
    {
        const double phase = 0.01 * (++turn % 100);
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
    // The meshes that deform leave the others, and get their copies.
    for (int i = 0; i < 3; ++i)
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

    // Everything moves once, which makes all objects instances, as they are in the yardstick.
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
    measureDeformed(rows, field, live, bare);
    measureSmallEdits(rows, field, live, bare, walk);
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
    instanceBytes(2); // memory that the process needs once
    const double few = instanceBytes(2), many = instanceBytes(kFieldObjects);
    rows.push_back({"10,000 instances of one mesh: beyond the mesh's own",
                    (many - few) / kFieldObjects, "bytes/instance", Goal::AtMost, 400.0});
}

} // namespace

void measureUpdate(Rows& rows)
{
    measureInstances(rows);
    measureInstanceRays(rows);
    measureEdits(rows);
    measureWatch(rows);
}

} // namespace osgRayTrace::bench
