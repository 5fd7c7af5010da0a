// DisplayTexture.h - a picture with depth on the screen, by OpenGL. Layer: public API, private.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/ChangedTiles.h"
#include "osgRayTrace/session/view/DepthSlices.h"

#include <osg/Geometry>
#include <osg/Image>
#include <osg/Program>
#include <osg/RenderInfo>
#include <osg/StateSet>
#include <osg/Texture2D>
#include <osg/Uniform>

#include <cstdint>

namespace osgRayTrace
{

/// Holds colour and depth of one view, drawn as a triangle that covers the viewport and writes
/// gl_FragDepth. The objects belong to the one context that draws the view. Storage here and in
/// OpenGL is kept while the size stays, for a picture of the view's size and for one of fewer
/// pixels, which may take turns. If a picture changes in parts, only these parts are copied to
/// OpenGL. Members are for the draw thread of that context, unless stated otherwise.
class DisplayTexture
{
public:
    DisplayTexture();
    DisplayTexture(const DisplayTexture&) = delete;
    DisplayTexture& operator=(const DisplayTexture&) = delete;

    /// Returns the state that the drawable needs in its StateSet: premultiplied blending and a
    /// solid unculled triangle, drawn after the opaque things of bin 0. osg::State knows all that
    /// draw() sets beyond it.
    static osg::ref_ptr<osg::StateSet> createStateSet();

    /// Makes room for width * height pixels; values are lost if the size changes. full: the picture
    /// has the view's size.
    void resize(int width, int height, bool full);

    /// Allocates memory for pictures of full size, once: the system takes long to hand it out, and
    /// the frame in which a view comes to rest has no time for that.
    void reserve(int width, int height);
    int width() const { return _shown->width; }
    int height() const { return _shown->height; }

    /// Returns the display values, to be written before a call of modified(): 4 bytes a pixel, row
    /// 0 at the bottom. Alpha is coverage, nothing is drawn if it is 0, and colours are multiplied
    /// with it. depth() returns window depths in [0,1].
    uint8_t* rgba() { return _shown->color->data(); }
    float* depth() { return reinterpret_cast<float*>(_shown->depth->data()); }
    void modified();
    void modified(const engine::ChangedTiles& tiles); ///< tiles: all that was modified

    /// Drops the picture: the size is 0 until there is another one.
    void clear();

    /// Puts images of equal size, allocated as resize() does it, in place of the present ones.
    void show(osg::Image* color, osg::Image* depth);

    /// Fills the current viewport, which may have another size than the picture: colours are then
    /// smooth, and depths are not, because a depth between two surfaces belongs to neither. Depths
    /// are mapped by depthMap. Returns false, and draws nothing, if the context has no usable GLSL.
    bool draw(osg::RenderInfo& renderInfo, const engine::DepthMap& depthMap);

    /// Releases OpenGL's objects in any thread that OSG calls it from; null: of all contexts.
    void releaseGLObjects(osg::State* state) const;
    void resizeGLObjectBuffers(unsigned int maxSize);

private:
    struct Picture
    {
        Picture();

        int width = 0;
        int height = 0;
        osg::ref_ptr<osg::Image> color;
        osg::ref_ptr<osg::Image> depth;
        osg::ref_ptr<osg::Texture2D> colorTexture;
        osg::ref_ptr<osg::Texture2D> depthTexture;
        engine::ChangedTiles changed; ///< tiles changed since the textures last held the images
    };

    static void allocate(Picture& picture, int width, int height);
    bool useProgram(osg::State& state) const;
    void chooseFilter(const osg::State& state) const;
    void applyPicture(osg::State& state);

    Picture _full, _reduced;
    Picture* _shown = &_full;
    bool _hasDrawn = false;
    osg::ref_ptr<osg::Uniform> _colorUnit;
    osg::ref_ptr<osg::Uniform> _depthUnit;
    osg::ref_ptr<osg::Uniform> _depthMap;
    osg::ref_ptr<osg::Program> _program;     ///< GLSL 1.20
    osg::ref_ptr<osg::Program> _coreProgram; ///< GLSL 3.30, for contexts that take no older one
    osg::ref_ptr<osg::Geometry> _triangle;
};

} // namespace osgRayTrace
