// LiveGraph.h - a small scene graph that is edited, and a view of it without OpenGL. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/update/SceneUpdater.h"
#include "osgRayTrace/session/view/ViewTracer.h"

#include <osg/LightSource>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/PositionAttitudeTransform>
#include <osg/Texture2D>

#include <string>
#include <vector>

namespace osgRayTrace::test
{

/// Holds bumpy tiles side by side, each below a transform, with materials, one texture and a light.
struct LiveGraph
{
    static constexpr int kObjects = 6;

    LiveGraph();

    /// Returns a tile with triangles and state of its own at a place; the graph stays as it is.
    osg::ref_ptr<osg::MatrixTransform> newObject(int number, double x, double y) const;

    osg::Geometry& geometry(int object) { return *objects[object]->getChild(0)->asGeometry(); }

    void deform(int object, float height);
    void shuffle(int object);      ///< exchanges vertices, so that all triangles are long
    void dropTriangle(int object); ///< drops the last one
    void paint(int red);           ///< paints the texture

    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::PositionAttitudeTransform> group = new osg::PositionAttitudeTransform;
    osg::ref_ptr<osg::MatrixTransform> hidden = new osg::MatrixTransform;
    osg::ref_ptr<osg::LightSource> light = new osg::LightSource;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    std::vector<osg::ref_ptr<osg::Material>> materials;
    std::vector<osg::ref_ptr<osg::MatrixTransform>> objects;
};

void deformTile(osg::Geometry& tile, float height);

/// Does for a view what RayTraceDrawable does, without OpenGL.
class LiveView
{
public:
    explicit LiveView(osg::Node* root);

    void update();

    /// Does what RayTracedScene::dirtyScene does.
    void setDirty() { _updater.setDirty(); }

    /// Records another eye; the traced view stays the same.
    void recordEye(const osg::Vec3d& eye);

    /// Traces a pass and resolves the image: linear RGBA.
    const std::vector<float>& image();

    /// Returns the last result of image().
    const std::vector<float>& lastImage() const { return _last; }

    int passes() const { return _tracer.progress().passes; }
    Statistics statistics() const { return _updater.statistics(); }
    engine::SceneVersion version() const { return _updater.version(); }

    /// Does what picks do: from then on there is an index for them.
    engine::SceneVersion versionToPick()
    {
        return _updater.versionToPick(_root, *_settings, osg::Vec3d());
    }

    const engine::Scene* scene() const { return &_updater.version().inputs.scene->scene(); }

private:
    osg::Node* _root;
    osg::ref_ptr<RayTraceSettings> _settings = new RayTraceSettings;
    engine::SceneUpdater _updater;
    engine::ViewTracer _tracer;
    std::vector<float> _last;
};

/// Returns the image that this many passes give of a scene that has just been converted.
std::vector<float> freshImage(const osg::Node& root, int passes);

/// Counts the pixels in which two images of one size differ by more than rounding.
int differentPixels(const std::vector<float>& a, const std::vector<float>& b);

/// Updates, traces a pass and returns how many pixels differ from a fresh conversion; all pixels
/// count if the update failed.
int wrongPixels(LiveView& view, const osg::Node& root);

/// In this many pixels of 96 x 96 rounding decides which side of an edge a ray passes.
constexpr int kRoundedPixels = 8;

} // namespace osgRayTrace::test
