// SmallEdits.cpp - edits objects one by one. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/SmallEdits.h"

#include "osgRayTrace/base/Parallel.h"

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

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

} // namespace

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

} // namespace osgRayTrace::bench
