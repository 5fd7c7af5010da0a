// DisplayTexture.cpp - the shaders, and what OSG and OpenGL are told. Layer: public API, private.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/DisplayTexture.h"

#include "osgRayTrace/DisplayShaders.h"

#include <osg/BlendFunc>
#include <osg/GLExtensions>
#include <osg/PolygonMode>
#include <osg/State>
#include <osg/Viewport>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#ifndef GL_CONTEXT_PROFILE_MASK
#define GL_CONTEXT_PROFILE_MASK 0x9126
#endif
#ifndef GL_CONTEXT_CORE_PROFILE_BIT
#define GL_CONTEXT_CORE_PROFILE_BIT 0x00000001
#endif

namespace osgRayTrace
{

namespace
{

constexpr unsigned int kColorUnit = 0;
constexpr unsigned int kDepthUnit = 1;
constexpr unsigned int kCornerLocation = 0;

osg::ref_ptr<osg::Program> createProgram(const std::string& vertexDialect,
                                         const std::string& fragmentDialect)
{
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->setName("osgRayTrace");
    program->addShader(new osg::Shader(osg::Shader::VERTEX, vertexDialect + kVertexShader));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, fragmentDialect + kFragmentShader));
    program->addBindAttribLocation("corner", kCornerLocation);
    return program;
}

osg::ref_ptr<osg::Texture2D> createTexture(osg::Image* image, GLint internalFormat)
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    texture->setImage(image);
    texture->setInternalFormat(internalFormat);
    texture->setResizeNonPowerOfTwoHint(false);
    texture->setUnRefImageDataAfterApply(false);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    return texture;
}

/// Returns a triangle whose lower left half covers the viewport. A generic attribute works in every
/// profile.
osg::ref_ptr<osg::Geometry> createTriangle()
{
    osg::ref_ptr<osg::Vec2Array> corners = new osg::Vec2Array(osg::Array::BIND_PER_VERTEX);
    corners->push_back(osg::Vec2(-1.0f, -1.0f));
    corners->push_back(osg::Vec2(3.0f, -1.0f));
    corners->push_back(osg::Vec2(-1.0f, 3.0f));

    osg::ref_ptr<osg::Geometry> triangle = new osg::Geometry;
    triangle->setUseDisplayList(false);
    triangle->setUseVertexBufferObjects(true);
    triangle->setVertexAttribArray(kCornerLocation, corners.get());
    triangle->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    return triangle;
}

bool isCoreProfile(const osg::GLExtensions& extensions)
{
    if (extensions.glVersion < 3.2f) return false;
    GLint profile = 0;
    glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    return (profile & GL_CONTEXT_CORE_PROFILE_BIT) != 0;
}

/// Returns the depth right in front of the background in a buffer that has fewer bits than the 24
/// for which depth was chosen. A core profile does not tell its bits: 24 are taken for granted
/// there.
float inFrontOfBackground(float depth, const osg::State& state)
{
    GLint bits = 24;
    if (!isCoreProfile(*state.get<osg::GLExtensions>())) glGetIntegerv(GL_DEPTH_BITS, &bits);
    if (depth < 0.0f || bits < 1 || bits >= 24) return depth;
    const float unit = 1.0f / static_cast<float>((1 << bits) - 1);
    return std::clamp(depth, unit, 1.0f - unit);
}

/// Makes osg::State forget its vertex arrays: it would go on with a buffer that may have been
/// released by then.
void forgetVertexArrays(osg::State& state)
{
    state.lazyDisablingOfVertexAttributes();
    state.applyDisablingOfVertexAttributes();
}

/// Applies the image even if osg::State thinks that the texture is bound: the image's values may be
/// new, or the texture may stand at the address of one that is gone.
void applyTexture(osg::State& state, unsigned int unit, const osg::Texture2D& texture)
{
    state.haveAppliedTextureAttribute(unit, osg::StateAttribute::TEXTURE);
    state.applyTextureAttribute(unit, &texture);
}

/// Copies rectangles of the image to the texture that is applied, which has the image's size.
void copyRects(osg::State& state, const osg::Image& image,
               const std::vector<engine::PixelRect>& rects)
{
    state.unbindPixelBufferObject();
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4); // right for both formats
    glPixelStorei(GL_UNPACK_ROW_LENGTH, image.s());
    for (const engine::PixelRect& rect : rects)
        glTexSubImage2D(GL_TEXTURE_2D, 0, rect.x, rect.y, rect.width, rect.height,
                        image.getPixelFormat(), image.getDataType(), image.data(rect.x, rect.y));
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

/// Brings the texture up to the image: all of it, if the image is dirty or OpenGL has lost the
/// texture; otherwise the marked tiles.
void applyChanged(osg::State& state, unsigned int unit, const osg::Texture2D& texture,
                  osg::Image& image, const std::vector<uint8_t>& marks)
{
    applyTexture(state, unit, texture);
    const std::vector<engine::PixelRect> rects = engine::changedRects(marks, image.s(), image.t());
    if (rects.empty()) return;
    if (texture.getTextureWidth() == image.s() && texture.getTextureHeight() == image.t())
    {
        copyRects(state, image, rects);
        return;
    }
    image.dirty(); // OpenGL takes no image that large and has a smaller one
    applyTexture(state, unit, texture);
}

/// Unbinds sampler objects, whose filters would replace those of the picture: OSG leaves one bound
/// to a unit on which a scene has had an osg::Sampler.
void unbindSamplers(osg::State& state)
{
    const osg::GLExtensions& extensions = *state.get<osg::GLExtensions>();
    if (!extensions.glBindSampler) return;
    for (const unsigned int unit : {kColorUnit, kDepthUnit})
    {
        if (!state.getLastAppliedTextureAttribute(unit, osg::StateAttribute::SAMPLER)) continue;
        extensions.glBindSampler(unit, 0);
        state.haveAppliedTextureAttribute(unit, osg::StateAttribute::SAMPLER);
    }
}

} // namespace

DisplayTexture::Picture::Picture()
    : color(new osg::Image),
      depth(new osg::Image),
      colorTexture(createTexture(color.get(), GL_RGBA8)),
      depthTexture(createTexture(depth.get(), GL_LUMINANCE32F_ARB))
{
}

DisplayTexture::DisplayTexture()
    : _colorUnit(new osg::Uniform("osgRayTrace_color", static_cast<int>(kColorUnit))),
      _depthUnit(new osg::Uniform("osgRayTrace_depth", static_cast<int>(kDepthUnit))),
      _depthMap(new osg::Uniform("osgRayTrace_depthMap", osg::Vec3(1.0f, 0.0f, 1.0f))),
      _program(createProgram(kVertexDialect, kFragmentDialect)),
      _coreProgram(createProgram(kCoreVertexDialect, kCoreFragmentDialect)),
      _triangle(createTriangle())
{
}

osg::ref_ptr<osg::StateSet> DisplayTexture::createStateSet()
{
    using osg::StateAttribute;
    osg::ref_ptr<osg::StateSet> stateSet = new osg::StateSet;
    stateSet->setAttributeAndModes(new osg::BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA),
                                   StateAttribute::ON | StateAttribute::PROTECTED);
    stateSet->setMode(GL_CULL_FACE, StateAttribute::OFF | StateAttribute::PROTECTED);
    stateSet->setAttribute(new osg::PolygonMode, StateAttribute::ON | StateAttribute::PROTECTED);
    stateSet->setRenderBinDetails(1, "RenderBin");
    return stateSet;
}

void DisplayTexture::resize(int width, int height, bool full)
{
    Picture& picture = full ? _full : _reduced;
    _shown = &picture;
    allocate(picture, width, height);
}

void DisplayTexture::reserve(int width, int height)
{
    if (_full.width > 0) return;
    allocate(_full, width, height);
    std::memset(_full.color->data(), 0, _full.color->getTotalSizeInBytes());
    std::memset(_full.depth->data(), 0, _full.depth->getTotalSizeInBytes());
}

void DisplayTexture::allocate(Picture& picture, int width, int height)
{
    if (width == picture.width && height == picture.height) return;
    picture.width = picture.height =
        0; // 0 until all is allocated: memory may suffice for a part only
    picture.color->allocateImage(width, height, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    picture.depth->allocateImage(width, height, 1, GL_LUMINANCE, GL_FLOAT);
    picture.changed.reset(width, height);
    picture.width = width;
    picture.height = height;
}

void DisplayTexture::modified()
{
    _shown->color->dirty();
    _shown->depth->dirty();
    _shown->changed.reset(_shown->width, _shown->height);
}

void DisplayTexture::modified(const engine::ChangedTiles& tiles)
{
    if (tiles.width == _shown->width && tiles.height == _shown->height)
        _shown->changed.add(tiles);
    else
        modified();
}

void DisplayTexture::clear()
{
    for (Picture* picture : {&_full, &_reduced})
        picture->width = picture->height = 0;
    _shown = &_full;
}

void DisplayTexture::show(osg::Image* color, osg::Image* depth)
{
    _shown = &_full;
    _full.color = color;
    _full.depth = depth;
    _full.colorTexture->setImage(color);
    _full.depthTexture->setImage(depth);
    _full.width = color->s();
    _full.height = color->t();
    modified();
}

/// Makes OSG create its lists of a context's deleted programs and shaders. OSG would do so when the
/// first one is deleted, in whatever thread that happens and without a lock, while the context's
/// own thread may go through the lists: osg::ContextData::get() of OSG 3.6.5. The next view that
/// draws, which may be of another context, forgets the views that nobody draws any more.
static void makeDeletionLists(osg::State& state)
{
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    program->getPCP(state);
    const osg::ref_ptr<osg::Shader> shader = new osg::Shader(osg::Shader::VERTEX);
    shader->getPCS(state);
}

bool DisplayTexture::draw(osg::RenderInfo& renderInfo, const engine::DepthMap& depthMap)
{
    osg::State& state = *renderInfo.getState();
    const osg::Vec3 map(depthMap.scale, depthMap.offset,
                        inFrontOfBackground(depthMap.background, state));
    osg::Vec3 last;
    _depthMap->get(last);
    if (map != last) _depthMap->set(map);
    if (!useProgram(state)) return false;
    if (!_hasDrawn) makeDeletionLists(state);
    _hasDrawn = true;
    chooseFilter(state);
    unbindSamplers(state);
    applyPicture(state);
    _triangle->draw(renderInfo);
    if (!state.useVertexArrayObject(_triangle->getUseVertexArrayObject()))
        forgetVertexArrays(state);
    return true;
}

void DisplayTexture::applyPicture(osg::State& state)
{
    Picture& picture = *_shown;
    engine::ChangedTiles& changed = picture.changed;
    applyChanged(state, kColorUnit, *picture.colorTexture, *picture.color, changed.color);
    applyChanged(state, kDepthUnit, *picture.depthTexture, *picture.depth, changed.depth);
    changed.reset(picture.width, picture.height);
}

/// Chooses the nearest pixel if sizes agree: a linear filter rounds and takes longer.
void DisplayTexture::chooseFilter(const osg::State& state) const
{
    const osg::Viewport* viewport = state.getCurrentViewport();
    const bool fits = viewport && static_cast<int>(viewport->width()) == width() &&
                      static_cast<int>(viewport->height()) == height();
    const auto filter = fits ? osg::Texture::NEAREST : osg::Texture::LINEAR;
    osg::Texture2D& texture = *_shown->colorTexture;
    if (texture.getFilter(osg::Texture::MAG_FILTER) == filter) return;
    texture.setFilter(osg::Texture::MIN_FILTER, filter);
    texture.setFilter(osg::Texture::MAG_FILTER, filter);
}

bool DisplayTexture::useProgram(osg::State& state) const
{
    const osg::GLExtensions& extensions = *state.get<osg::GLExtensions>();
    if (!extensions.isGlslSupported) return false;

    const bool core = isCoreProfile(extensions);
    if (core)
    {
        _shown->depth->setPixelFormat(GL_RED);
        _shown->depthTexture->setInternalFormat(GL_R32F);
        // Only a core profile gets a vertex array object: OSG 3.6 leaves the vertex buffer bound
        // with it, which breaks client-side arrays.
        _triangle->setUseVertexArrayObject(true);
    }
    state.haveAppliedAttribute(osg::StateAttribute::PROGRAM);
    state.applyAttribute(core ? _coreProgram.get() : _program.get());
    const osg::Program::PerContextProgram* program = state.getLastAppliedProgramObject();
    if (!program || !program->isLinked()) return false;
    program->apply(*_colorUnit);
    program->apply(*_depthUnit);
    program->apply(*_depthMap);
    return true;
}

void DisplayTexture::releaseGLObjects(osg::State* state) const
{
    for (const Picture* picture : {&_full, &_reduced})
    {
        picture->colorTexture->releaseGLObjects(state);
        picture->depthTexture->releaseGLObjects(state);
    }
    _program->releaseGLObjects(state);
    _coreProgram->releaseGLObjects(state);
    _triangle->releaseGLObjects(state);
}

void DisplayTexture::resizeGLObjectBuffers(unsigned int maxSize)
{
    for (Picture* picture : {&_full, &_reduced})
    {
        picture->colorTexture->resizeGLObjectBuffers(maxSize);
        picture->depthTexture->resizeGLObjectBuffers(maxSize);
    }
    _program->resizeGLObjectBuffers(maxSize);
    _coreProgram->resizeGLObjectBuffers(maxSize);
    _triangle->resizeGLObjectBuffers(maxSize);
}

} // namespace osgRayTrace
