// UpdateMode.cpp - edits of a live scene against Embree's own work. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/UpdateMode.h"

#include "apps/osgraytracebench/ResidentBytes.h"
#include "apps/osgraytracebench/Timing.h"
#include "apps/osgraytracebench/modes/InstanceRays.h"
#include "apps/osgraytracebench/scenes/ObjectField.h"
#include "osgRayTrace/bridge/update/SceneUpdater.h"

#include <string>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr int kRuns = 21;
constexpr unsigned int kDeformedStep = 100; // every 100th object: 1 %

/// Holds an updater on one thread; update() does the work of a frame.
class LiveScene
{
public:
    explicit LiveScene(osg::Node* root) : _root(root)
    {
        _settings->setThreads(1);
        _updater.recordView(nullptr, nullptr, ViewingConditions());
        update();
    }

    void update() { _updater.update(_root, *_settings, nullptr); }
    void setDirty() { _updater.setDirty(); }
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

/// Adds rows of an edit whose cost must not be in proportion to the scene. The last row is the cost
/// beyond the walk that finds the edit.
void addEdit(Rows& rows, LiveScene& live, const std::string& what, double walk, double whole,
             const std::function<void()>& edit)
{
    const Statistics before = live.statistics();
    const double seconds = medianSeconds(
        [&]
        {
            edit();
            live.update();
        });
    const Statistics after = live.statistics();
    rows.push_back({what, seconds * 1e3, "ms", Goal::AtMost, 3.0});
    rows.push_back({what + ": beyond the walk", (seconds - walk) * 1e3, "ms", Goal::AtMost, 2.0});
    rows.push_back({what + " / whole conversion", seconds / whole, "times"});
    rows.push_back({what + ": commits of Embree",
                    double(after.embreeCommits - before.embreeCommits), "", Goal::AtMost, 0.0});
    rows.push_back({what + ": whole conversions", double(after.conversions - before.conversions),
                    "", Goal::AtMost, 0.0});
}

/// Adds rows of an object that comes and goes; it is built anew each time. Embree's own work is the
/// object's mesh and the top level.
void addComingAndGoing(Rows& rows, ObjectField& field, LiveScene& live, BareField& bare,
                       const Workers& one)
{
    const Statistics before = live.statistics();
    std::vector<double> added, removed, commits, ratios, removalRatios;
    for (int i = 0; i <= kRuns; ++i)
    {
        const osg::ref_ptr<osg::MatrixTransform> object = field.newObject();
        field.root->insertChild(5000, object);
        added.push_back(threadSecondsOf([&] { live.update(); }));
        commits.push_back(threadSecondsOf(
            [&]
            {
                one.run(
                    [&]
                    {
                        bare.build(field, 5000);
                        bare.move(5000, field.place(5000, 0.001 * i));
                    });
            }));
        field.root->removeChild(object);
        removed.push_back(threadSecondsOf([&] { live.update(); }));
        ratios.push_back(added.back() / commits.back());
        removalRatios.push_back(removed.back() / commits.back());
    }
    addPair(rows, "one object added", "Embree's build and commit",
            {median(added), median(commits), median(ratios)}, 2.0);
    addPair(rows, "one object removed", "Embree's build and commit",
            {median(removed), median(commits), median(removalRatios)}, 2.0);
    rows.push_back({"objects added and removed: whole conversions",
                    double(live.statistics().conversions - before.conversions), "", Goal::AtMost,
                    0.0});
}

void measureSmallEdits(Rows& rows, ObjectField& field, LiveScene& live, BareField& bare,
                       double walk)
{
    const Workers one(1);
    int turn = 0;
    const auto value = [&turn] { return 0.01f * float(++turn % 100); };
    live.update();
    const double whole = medianSeconds(
        [&]
        {
            live.setDirty();
            live.update();
        });
    rows.push_back({"dirtyScene(): whole conversion, all arrays read again", whole * 1e3, "ms"});
    addEdit(rows, live, "a material edited", walk, whole,
            [&]
            {
                field.materials[7]->setDiffuse(osg::Material::FRONT_AND_BACK,
                                               osg::Vec4(value(), 0.0f, 0.0f, 1.0f));
            });
    addEdit(rows, live, "a light edited", walk, whole,
            [&] { field.light->getLight()->setDiffuse(osg::Vec4(value(), 1.0f, 1.0f, 1.0f)); });
    addEdit(rows, live, "a texture edited", walk, whole,
            [&]
            {
                *field.image->data() = static_cast<unsigned char>(100.0f * value());
                field.image->dirty();
            });
    addComingAndGoing(rows, field, live, bare, one);
}

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
}

} // namespace osgRayTrace::bench
