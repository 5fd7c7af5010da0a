// GraphGenerator.cpp - scene graphs of random nodes, matrices, states, lights and geometries.
// Layer: tests.
// SPDX-License-Identifier: MIT
#include "GraphGenerator.h"

#include "GeometryGenerator.h"
#include "StateGenerator.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/EnvironmentLight>

#include <osg/AutoTransform>
#include <osg/Billboard>
#include <osg/Camera>
#include <osg/ClipNode>
#include <osg/Geode>
#include <osg/LOD>
#include <osg/LightSource>
#include <osg/MatrixTransform>
#include <osg/ProxyNode>
#include <osg/Sequence>
#include <osg/ShapeDrawable>
#include <osg/Switch>
#include <osgAnimation/Bone>
#include <osgAnimation/MorphGeometry>
#include <osgAnimation/MorphTransformHardware>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/RigTransformHardware>
#include <osgAnimation/Skeleton>

namespace osgRayTrace::test
{

namespace
{

osg::Vec3d vectorWithin(Dice& dice, double size)
{
    return {dice.between(-size, size), dice.between(-size, size), dice.between(-size, size)};
}

osg::Matrixd randomMatrix(Dice& dice)
{
    using osg::Matrixd;
    constexpr double kScales[] = {0.0, -1.0, 1e-20, 1e-7, 1e3, 1e9, 1e20, 1e300};
    osg::Matrixd matrix = Matrixd::scale(osg::Vec3d(1, 1, 1) + vectorWithin(dice, 0.5)) *
                          Matrixd::rotate(dice.between(0.0, 6.3), vectorWithin(dice, 1.0)) *
                          Matrixd::translate(vectorWithin(dice, 1.0));
    switch (dice.below(10))
    {
    case 0:
        return Matrixd::scale(dice.oneOf(kScales), dice.oneOf(kScales), dice.oneOf(kScales));
    case 1:
        matrix(dice.below(4), dice.below(4)) = dice.strange(1.0, 2);
        return matrix;
    case 2:
        matrix.postMultTranslate(osg::Vec3d(dice.strange(1e7, 2), 0.0, 0.0));
        return matrix;
    default:
        return matrix;
    }
}

/// Computes the bound of all vertices. OSG's own callback reads through indices, and beyond the
/// arrays if the indices are wrong, so an application with such a geometry has to set this one
/// before OSG can draw.
struct BoundOfVertices : osg::Drawable::ComputeBoundingBoxCallback
{
    osg::BoundingBox computeBound(const osg::Drawable& drawable) const override
    {
        osg::BoundingBox box;
        const osg::Geometry& geometry = *drawable.asGeometry();
        const auto* vertices = dynamic_cast<const osg::Vec3Array*>(geometry.getVertexArray());
        for (std::size_t i = 0; vertices && i < vertices->size(); ++i)
            box.expandBy((*vertices)[i]);
        return box;
    }
};

class GraphMaker
{
public:
    explicit GraphMaker(Dice& dice) : _dice(dice) {}

    RandomGraph make()
    {
        _graph.bounded = _dice.oneIn(2);
        _graph.root = new osg::Group;
        for (int i = 1 + _dice.below(4); i > 0; --i)
            _graph.root->addChild(node(0));
        return std::move(_graph);
    }

private:
    osg::ref_ptr<osg::Node> node(int depth)
    {
        if (!_made.empty() && _dice.oneIn(5))
            return _made[_dice.below(static_cast<int>(_made.size()))];
        osg::ref_ptr<osg::Node> made = depth > 3 || _dice.oneIn(2) ? leaf() : group(depth);
        if (_dice.oneIn(3)) made->setStateSet(randomStateSet(_dice));
        _made.push_back(made);
        return made;
    }

    osg::ref_ptr<osg::Node> leaf()
    {
        switch (_dice.below(11))
        {
        case 10:
            return environment();
        case 8:
            return rig();
        case 9:
            return morph();
        case 0:
            return areaLight();
        case 1:
            return lightSource();
        case 2:
            return shape();
        default:
            return geometry();
        }
    }

    osg::ref_ptr<osg::Geometry> geometry()
    {
        osg::ref_ptr<osg::Geometry> made = randomGeometry(_dice);
        if (_graph.bounded) made->setComputeBoundingBoxCallback(new BoundOfVertices);
        _graph.geometries.push_back(made);
        return made;
    }

    /// Returns a rig whose arrays and influences, through which osgAnimation would read and write,
    /// may be wrong.
    osg::ref_ptr<osg::Node> rig()
    {
        osg::ref_ptr<osgAnimation::RigGeometry> made = new osgAnimation::RigGeometry;
        const osg::ref_ptr<osg::Geometry> source = randomGeometry(_dice);
        made->setSourceGeometry(_dice.oneIn(8) ? nullptr : source.get());
        if (_dice.oneIn(2))
            made->setRigTransformImplementation(new osgAnimation::RigTransformHardware);
        if (_graph.bounded || _dice.oneIn(2))
            made->setComputeBoundingBoxCallback(new BoundOfVertices);
        osg::ref_ptr<osgAnimation::VertexInfluenceMap> influences =
            new osgAnimation::VertexInfluenceMap;
        const osg::Array* vertices = source->getVertexArray();
        const auto count = vertices ? static_cast<int>(vertices->getNumElements()) : 0;
        const char* names[] = {"bone 0", "bone 1", "", "no such bone"};
        for (int i = _dice.below(2 * count + 4); i > 0; --i)
        {
            const unsigned int vertex =
                _dice.oneIn(100) || count == 0 ? _dice.bits() : unsigned(_dice.below(count));
            (*influences)[_dice.oneOf(names)].push_back(
                osgAnimation::VertexIndexWeight(vertex, strangeFloat(_dice, 1.0, 30)));
        }
        if (!_dice.oneIn(8)) made->setInfluenceMap(influences);
        return below(made);
    }

    /// Returns the rig below a node, which as a rule is below a skeleton.
    osg::ref_ptr<osg::Node> below(osg::Node* rig)
    {
        osg::ref_ptr<osg::Group> holder = new osg::MatrixTransform(randomMatrix(_dice));
        holder->addChild(rig);
        if (_dice.oneIn(5)) return holder;
        osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
        for (const char* name : {"bone 0", "bone 1"})
        {
            osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone(name);
            bone->setInvBindMatrixInSkeletonSpace(randomMatrix(_dice));
            bone->setMatrixInSkeletonSpace(randomMatrix(_dice));
            skeleton->addChild(bone);
        }
        skeleton->addChild(holder);
        return skeleton;
    }

    osg::ref_ptr<osg::Node> morph()
    {
        osg::ref_ptr<osgAnimation::MorphGeometry> made =
            new osgAnimation::MorphGeometry(*randomGeometry(_dice));
        if (_graph.bounded || _dice.oneIn(2))
            made->setComputeBoundingBoxCallback(new BoundOfVertices);
        for (int i = _dice.below(3); i > 0; --i)
            made->addMorphTarget(_dice.oneIn(9)
                                     ? nullptr
                                     : (_dice.oneIn(2)
                                            ? osg::ref_ptr<osg::Geometry>(new osg::Geometry(*made))
                                            : randomGeometry(_dice))
                                           .get(),
                                 strangeFloat(_dice, 1.0, 9));
        if (!_dice.oneIn(4))
            made->setMorphTransformImplementation(new osgAnimation::MorphTransformHardware);
        if (_dice.oneIn(4)) made->setMethod(osgAnimation::MorphGeometry::RELATIVE);
        if (_dice.oneIn(4)) made->setVertexSource(new osg::Vec3Array(_dice.below(9)));
        if (_dice.oneIn(4)) made->setNormalSource(new osg::Vec3Array(_dice.below(9)));
        made->setMorphNormals(_dice.oneIn(2));
        return made;
    }

    osg::ref_ptr<osg::Group> clipNode()
    {
        osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
        const int rarity = _dice.oneIn(3) ? 3 : 1 << 30;
        for (int i = _dice.below(4); i > 0; --i)
            clip->addClipPlane(
                new osg::ClipPlane(static_cast<unsigned int>(_dice.below(9)),
                                   _dice.strange(1.0, rarity), _dice.strange(1.0, rarity),
                                   _dice.strange(1.0, rarity), _dice.strange(0.5, rarity)));
        if (_dice.oneIn(4)) clip->setReferenceFrame(osg::ClipNode::ABSOLUTE_RF);
        return clip;
    }

    osg::ref_ptr<osg::Group> turning()
    {
        osg::ref_ptr<osg::AutoTransform> made = new osg::AutoTransform;
        made->setAutoRotateMode(static_cast<osg::AutoTransform::AutoRotateMode>(_dice.below(4)));
        made->setAutoScaleToScreen(_dice.oneIn(2));
        made->setPosition(
            osg::Vec3d(_dice.strange(1.0, 9), _dice.strange(1.0, 9), _dice.strange(1.0, 9)));
        if (_dice.oneIn(3)) made->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
        return made;
    }

    osg::ref_ptr<osg::Node> areaLight()
    {
        const int rarity = _dice.oneIn(2) ? 1 << 30 : 5;
        const auto vector = [&](double size)
        {
            return osg::Vec3(strangeFloat(_dice, size, rarity), strangeFloat(_dice, size, rarity),
                             strangeFloat(_dice, size, rarity));
        };
        osg::ref_ptr<AreaLight> light =
            new AreaLight(vector(2.0), vector(1.0), vector(1.0), vector(10.0));
        light->setTwoSided(_dice.oneIn(2));
        return light;
    }

    /// Returns an image of radiances, some of which no light has.
    osg::ref_ptr<osg::Image> sky(int width, int height)
    {
        osg::ref_ptr<osg::Image> image = new osg::Image;
        const int channels = _dice.oneIn(2) ? 3 : 4;
        image->allocateImage(width, height, 1, channels == 3 ? GL_RGB : GL_RGBA, GL_FLOAT);
        const int rarity = _dice.oneIn(2) ? 1 << 30 : 4;
        const double size = _dice.oneIn(4) ? 1e38 : _dice.between(0.0, 10.0);
        auto* values = reinterpret_cast<float*>(image->data());
        for (int i = 0; i < width * height * channels; ++i)
            values[i] = strangeFloat(_dice, size, rarity);
        return image;
    }

    osg::ref_ptr<osg::TextureCubeMap> cubeOfSkies()
    {
        osg::ref_ptr<osg::TextureCubeMap> cube = new osg::TextureCubeMap;
        const int size = 1 + _dice.below(4), faces = _dice.oneIn(6) ? _dice.below(7) : 6;
        for (int face = 0; face < faces; ++face)
            cube->setImage(static_cast<unsigned int>(face),
                           _dice.oneIn(30) ? randomImage(_dice) : sky(size, size));
        return cube;
    }

    osg::ref_ptr<osg::Node> environment()
    {
        osg::ref_ptr<EnvironmentLight> light = new EnvironmentLight;
        switch (_dice.below(6))
        {
        case 0:
            break;
        case 1:
            light->setCubeMap(cubeOfSkies());
            break;
        case 2:
            light->setImage(randomImage(_dice));
            break;
        default:
            light->setImage(sky(1 + _dice.below(16), 1 + _dice.below(8)));
        }
        const int rarity = _dice.oneIn(2) ? 1 << 30 : 4;
        const auto strange = [&](double size) { return _dice.strange(size, rarity); };
        light->setRotation(osg::Quat(strange(1.0), strange(1.0), strange(1.0), strange(1.0)));
        if (_dice.oneIn(2))
            light->setScale(osg::Vec3(strangeFloat(_dice, 2.0, rarity),
                                      strangeFloat(_dice, 2.0, rarity),
                                      strangeFloat(_dice, 2.0, rarity)));
        light->setVisible(_dice.oneIn(2));
        return light;
    }

    osg::ref_ptr<osg::Node> lightSource()
    {
        osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
        source->setLight(_dice.oneIn(12) ? nullptr : randomLight(_dice).get());
        if (_dice.oneIn(4)) source->setReferenceFrame(osg::LightSource::ABSOLUTE_RF);
        source->setStateSetModes(*_graph.root->getOrCreateStateSet(), osg::StateAttribute::ON);
        return source;
    }

    osg::ref_ptr<osg::Node> shape()
    {
        const osg::Vec3 centre(vectorWithin(_dice, 1.0));
        const float size = _dice.oneIn(6) ? strangeFloat(_dice, 1.0, 2)
                                          : static_cast<float>(_dice.between(0.1, 1.0));
        osg::ref_ptr<osg::Shape> made = new osg::Box(centre, size);
        if (_dice.oneIn(2)) made = new osg::Sphere(centre, size);
        osg::ref_ptr<osg::TessellationHints> hints = new osg::TessellationHints;
        hints->setDetailRatio(0.3f);
        return new osg::ShapeDrawable(made.get(), hints.get());
    }

    osg::ref_ptr<osg::Node> group(int depth)
    {
        osg::ref_ptr<osg::Group> made = emptyGroup();
        if (_dice.oneIn(10)) made->setNodeMask(_dice.bits());
        for (int i = _dice.below(4); i > 0; --i)
            made->addChild(node(depth + 1));
        return made;
    }

    osg::ref_ptr<osg::Group> emptyGroup()
    {
        switch (_dice.below(13))
        {
        case 10:
            return clipNode();
        case 11:
            return turning();
        case 12:
        {
            osg::ref_ptr<osg::ProxyNode> proxy = new osg::ProxyNode;
            if (_dice.oneIn(2)) proxy->setFileName(0, "none");
            return proxy;
        }
        case 0:
            return new osg::Switch;
        case 1:
            return new osg::Sequence;
        case 2:
        {
            osg::ref_ptr<osg::LOD> lod = new osg::LOD;
            lod->setCenter(osg::Vec3()); // otherwise OSG takes the centre of the bound
            lod->setRange(0, 0.0f, strangeFloat(_dice, 100.0, 2));
            return lod;
        }
        case 3:
        {
            osg::ref_ptr<osg::Billboard> billboard = new osg::Billboard;
            const osg::ref_ptr<osg::Geometry> drawn = geometry();
            billboard->addDrawable(drawn, osg::Vec3(vectorWithin(_dice, 1.0)));
            billboard->setMode(_dice.oneIn(2) ? osg::Billboard::POINT_ROT_EYE
                                              : osg::Billboard::AXIAL_ROT);
            return billboard;
        }
        case 4:
        {
            osg::ref_ptr<osg::Camera> camera = new osg::Camera;
            camera->setViewMatrix(randomMatrix(_dice));
            if (_dice.oneIn(2)) camera->setRenderOrder(osg::Camera::NESTED_RENDER);
            return camera;
        }
        case 5:
            return new osg::Group;
        default:
            return new osg::MatrixTransform(randomMatrix(_dice));
        }
    }

    Dice& _dice;
    RandomGraph _graph;
    std::vector<osg::ref_ptr<osg::Node>> _made; // used again as shared subgraphs
};

} // namespace

RandomGraph randomGraph(Dice& dice)
{
    return GraphMaker(dice).make();
}

} // namespace osgRayTrace::test
