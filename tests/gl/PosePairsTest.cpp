// PosePairsTest.cpp - geometries that poses move, and pictures that change, traced and rasterized.
// Layer: tests.
// SPDX-License-Identifier: MIT
#include "PicturePair.h"
#include "tests/Catch.h"

#include <osg/ImageStream>
#include <osg/MatrixTransform>
#include <osg/Texture2D>
#include <osgAnimation/Bone>
#include <osgAnimation/MorphGeometry>
#include <osgAnimation/MorphTransformHardware>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/RigTransformHardware>
#include <osgAnimation/RigTransformSoftware>
#include <osgAnimation/Skeleton>
#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/UpdateBone>

#include <cmath>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

PicturePair pairOf(const std::string& name, const SceneMaker& makeScene, int frames = 3)
{
    return picturePair(name, makeScene, lookDown, frames);
}

/// Returns a tube of rings along z, posed by two bones.
osg::ref_ptr<osg::Geometry> tube()
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array, normals = new osg::Vec3Array;
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    constexpr unsigned int kRings = 13, kSides = 16;
    for (unsigned int r = 0; r < kRings; ++r)
        for (unsigned int s = 0; s < kSides; ++s)
        {
            const float angle = 2.0f * float(osg::PI) * s / kSides;
            normals->push_back(osg::Vec3(std::cos(angle), std::sin(angle), 0.0f));
            positions->push_back(normals->back() * 0.3f + osg::Vec3(0.0f, 0.0f, 0.2f * r));
            if (r == 0) continue;
            const unsigned int a = r * kSides + s, b = r * kSides + (s + 1) % kSides;
            for (const unsigned int i : {a - kSides, b - kSides, a, a, b - kSides, b})
                triangles->push_back(i);
        }
    geometry->setVertexArray(positions);
    geometry->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    const osg::Vec4 color(0.9f, 0.5f, 0.2f, 1.0f);
    geometry->setColorArray(new osg::Vec4Array(1, &color), osg::Array::BIND_OVERALL);
    geometry->addPrimitiveSet(triangles);
    return geometry;
}

osg::ref_ptr<osgAnimation::Bone> bone(const std::string& name, const osg::Matrix& inSkeleton,
                                      const osg::Matrix& local)
{
    osg::ref_ptr<osgAnimation::Bone> made = new osgAnimation::Bone(name);
    made->setInvBindMatrixInSkeletonSpace(osg::Matrix::inverse(inSkeleton));
    osg::ref_ptr<osgAnimation::UpdateBone> update = new osgAnimation::UpdateBone(name);
    update->getStackedTransforms().push_back(new osgAnimation::StackedMatrixElement("m", local));
    made->setUpdateCallback(update);
    return made;
}

osg::ref_ptr<osg::Node> bentTube(osgAnimation::RigTransform* transform)
{
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    skeleton->setDefaultUpdateCallback();
    const osg::Matrix middle = osg::Matrix::translate(0.0, 0.0, 1.2);
    const auto lower = bone("lower", osg::Matrix(), osg::Matrix());
    const auto upper =
        bone("upper", middle, osg::Matrix::rotate(1.1, osg::Vec3d(0.0, 1.0, 0.0)) * middle);
    lower->addChild(upper);
    skeleton->addChild(lower);

    osg::ref_ptr<osgAnimation::RigGeometry> rig = new osgAnimation::RigGeometry;
    rig->setSourceGeometry(tube());
    osg::ref_ptr<osgAnimation::VertexInfluenceMap> influences =
        new osgAnimation::VertexInfluenceMap;
    const auto* positions =
        static_cast<osg::Vec3Array*>(rig->getSourceGeometry()->getVertexArray());
    for (unsigned int i = 0; i < positions->size(); ++i)
    {
        const float share = osg::clampBetween(((*positions)[i].z() - 0.8f) / 0.8f, 0.0f, 1.0f);
        if (share < 1.0f)
            (*influences)["lower"].push_back(osgAnimation::VertexIndexWeight(i, 1.0f - share));
        if (share > 0.0f)
            (*influences)["upper"].push_back(osgAnimation::VertexIndexWeight(i, share));
    }
    rig->setInfluenceMap(influences);
    rig->setRigTransformImplementation(transform);
    rig->setUpdateCallback(new osgAnimation::UpdateRigGeometry);
    skeleton->addChild(
        at(osg::Matrix::rotate(0.3, osg::Vec3d(0, 0, 1)) * osg::Matrix::translate(0.0, 0.0, 0.1),
           rig.get()));
    return at(osg::Matrix::rotate(-1.2, osg::Vec3d(1.0, 0.2, 0.0)) *
                  osg::Matrix::translate(0.0, -1.0, 0.0),
              skeleton.get());
}

osg::ref_ptr<osg::Node> fattened(osgAnimation::MorphTransform* transform)
{
    osg::ref_ptr<osgAnimation::MorphGeometry> morph = new osgAnimation::MorphGeometry(*tube());
    for (const float size : {1.8f, 0.4f})
    {
        const auto target = tube();
        for (osg::Vec3& p : *static_cast<osg::Vec3Array*>(target->getVertexArray()))
        {
            const float growth = 1.0f + (size - 1.0f) * std::fabs(std::sin(2.0f * p.z() * size));
            p = osg::Vec3(p.x() * growth, p.y() * growth, p.z());
        }
        morph->addMorphTarget(target, size > 1.0f ? 0.7f : 0.2f);
    }
    morph->setMorphTransformImplementation(transform);
    morph->setVertexSource(
        new osg::Vec3Array(*static_cast<osg::Vec3Array*>(morph->getVertexArray())));
    morph->setNormalSource(
        new osg::Vec3Array(*static_cast<osg::Vec3Array*>(morph->getNormalArray())));
    morph->dirty();
    return at(osg::Matrix::rotate(-1.2, osg::Vec3d(1.0, 0.2, 0.0)) *
                  osg::Matrix::translate(0.0, -1.0, 0.0),
              morph.get());
}

/// Returns a minimal vertex shader, which poses nothing. It only has to exist, in place of the one
/// that OSG would load from a file, because there is no such file.
osg::ref_ptr<osg::Shader> noShader()
{
    return new osg::Shader(
        osg::Shader::VERTEX,
        "void main() { gl_Position = ftransform(); gl_FrontColor = vec4(1.0); }");
}

/// A video that has one new picture a frame.
class Video : public osg::ImageStream
{
public:
    Video() { show(0); }
    bool requiresUpdateCall() const override { return true; }
    void update(osg::NodeVisitor* visitor) override
    {
        show(visitor->getFrameStamp() ? visitor->getFrameStamp()->getFrameNumber() : 0);
    }

private:
    void show(unsigned int frame)
    {
        if (!data()) allocateImage(16, 16, 1, GL_RGB, GL_UNSIGNED_BYTE);
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x)
            {
                const bool lit = (x / 4 + y / 4 + int(frame)) % 2 == 0;
                data(x, y)[0] = lit ? 230 : 30;
                data(x, y)[1] = static_cast<unsigned char>(60 * (frame % 5));
                data(x, y)[2] = lit ? 20 : 160;
            }
        dirty();
    }
};

} // namespace

TEST_CASE("pairs: a rig whose transform is left to the hardware", "[gl]")
{
    bool software = true; // the rasterized one comes first
    const PicturePair pair =
        pairOf("rig",
               [&]
               {
                   osg::ref_ptr<osgAnimation::RigTransformHardware> hardware =
                       new osgAnimation::RigTransformHardware;
                   hardware->setShader(noShader());
                   const auto scene = software ? bentTube(new osgAnimation::RigTransformSoftware)
                                               : bentTube(hardware);
                   software = false;
                   return scene;
               });
    CHECK(agree(pair));
}

TEST_CASE("pairs: a morph whose transform is left to the hardware", "[gl]")
{
    bool software = true;
    const PicturePair pair =
        pairOf("morph",
               [&]
               {
                   osg::ref_ptr<osgAnimation::MorphTransformHardware> hardware =
                       new osgAnimation::MorphTransformHardware;
                   hardware->setShader(noShader());
                   const auto scene = software ? fattened(new osgAnimation::MorphTransformSoftware)
                                               : fattened(hardware);
                   software = false;
                   return scene;
               });
    CHECK(agree(pair));
}

TEST_CASE("pairs: a video shows the picture of the frame", "[gl]")
{
    const PicturePair pair = pairOf(
        "video",
        []
        {
            osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(new Video);
            texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
            texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
            texture->setResizeNonPowerOfTwoHint(false);
            const auto square = unlitSquare(2.0f, osg::Vec4(1, 1, 1, 1));
            square->getOrCreateStateSet()->setTextureAttributeAndModes(0, texture);
            return square;
        },
        4);
    CHECK(agree(pair));
}
