// ModelsTest.cpp - real models convert; OSG_FILE_PATH leads to the OpenSceneGraph sample data.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"

#include <osg/Billboard>
#include <osg/ComputeBoundsVisitor>
#include <osgDB/FileUtils>
#include <osgDB/ReadFile>

#include <cmath>

using namespace osgRayTrace::engine;

namespace
{

/// Adds up the triangles that OSG finds, without any code of the bridge.
struct TriangleCounter : public osg::NodeVisitor
{
    TriangleCounter() : osg::NodeVisitor(TRAVERSE_ACTIVE_CHILDREN) {}
    using osg::NodeVisitor::apply;
    void apply(osg::Geometry& geometry) override
    {
        for (unsigned int i = 0; i < geometry.getNumPrimitiveSets(); ++i)
        {
            const osg::PrimitiveSet& set = *geometry.getPrimitiveSet(i);
            const GLenum mode = set.getMode();
            if (mode < GL_TRIANGLES) continue;
            if (const auto* lengths = dynamic_cast<const osg::DrawArrayLengths*>(&set))
                for (const GLsizei length : *lengths)
                    triangles += trianglesOf(mode, length);
            else
                triangles += trianglesOf(mode, set.getNumIndices());
        }
    }
    void apply(osg::Billboard& billboard) override
    {
        hasBillboards = true;
        traverse(billboard);
    }
    static uint64_t trianglesOf(GLenum mode, uint64_t count)
    {
        if (mode == GL_TRIANGLES) return count / 3;
        if (mode == GL_QUADS) return count / 4 * 2;
        if (mode == GL_QUAD_STRIP) return count < 4 ? 0 : count / 2 * 2 - 2;
        return count < 3 ? 0 : count - 2;
    }
    uint64_t triangles = 0;
    bool hasBillboards = false;
};

void checkModel(const std::string& file)
{
    if (osgDB::findDataFile(file).empty())
    {
        WARN("skipped: " << file << " not found; set OSG_FILE_PATH");
        return;
    }
    INFO(file);
    const osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(file);
    REQUIRE(model);
    SceneConverter converter;
    const ConversionResult result = converter.convert(inputFor(model));
    const Scene& scene = *result.scene;
    REQUIRE_FALSE(scene.instances.empty());

    CHECK(converter.convert(inputFor(model)).scene == result.scene);

    uint64_t triangles = 0;
    osg::BoundingBoxd box;
    for (const Instance& instance : scene.instances)
    {
        const Mesh& mesh = *scene.meshes.at(instance.mesh);
        triangles += mesh.triangles.size();
        REQUIRE(instance.material < scene.materials.size());
        for (const UVec3& t : mesh.triangles)
            for (int corner = 0; corner < 3; ++corner)
            {
                REQUIRE(t[corner] < mesh.positions.size());
                const Vec3 local = mesh.positions[t[corner]];
                REQUIRE(isFinite(local));
                const Vec3 p =
                    instance.placed ? transformPoint(instance.engineFromLocal, local) : local;
                box.expandBy(p.x, p.y, p.z);
            }
        for (const auto size : {mesh.normals.size(), mesh.uvs.size(), mesh.colors.size()})
            CHECK((size == 0 || size == mesh.positions.size()));
        for (const Vec3& n : mesh.normals)
            REQUIRE(std::fabs(glm::dot(n, n) - 1.0f) < 2e-3f);
        const uint32_t texture = scene.materials[instance.material].baseColorTexture;
        if (texture != kInvalid) CHECK(texture < scene.textures.size());
    }

    TriangleCounter counter;
    model->accept(counter);
    CHECK(triangles + countOf(result, "skipped.degenerate") == counter.triangles);
    CHECK(countOf(result, "skipped.not-finite") == 0);
    CHECK(countOf(result, "skipped.index-out-of-range") == 0);

    osg::ComputeBoundsVisitor bounds(osg::NodeVisitor::TRAVERSE_ACTIVE_CHILDREN);
    model->accept(bounds);
    const double tolerance = 1e-4 * bounds.getBoundingBox().radius();
    const osg::BoundingSphere sphere = model->getBound();
    CHECK((osg::Vec3d(box.center()) - osg::Vec3d(sphere.center())).length() < sphere.radius());
    if (counter.hasBillboards) return; // OSG's bounds leave out the positions of billboards
    CHECK((osg::Vec3d(box.center()) - osg::Vec3d(bounds.getBoundingBox().center())).length() <
          tolerance);
    CHECK(std::fabs(box.radius() - bounds.getBoundingBox().radius()) < tolerance);
}

} // namespace

TEST_CASE("sample models keep all their triangles, their size and their normals", "[osg-data]")
{
    for (const char* file :
         {"cow.osgt", "cessna.osgt", "glider.osgt", "lz.osgt", "dumptruck.osgt", "simpleroom.osgt"})
        checkModel(file);
}
