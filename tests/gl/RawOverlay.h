// RawOverlay.h - draws by calls of OpenGL with a program of its own, like ImGui. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Camera>
#include <osg/Drawable>
#include <osg/GL>
#include <osg/GLExtensions>

/// The namespace is not osgRayTrace, as the classes stand for those of an application.
namespace application
{

/// Draws half-transparent magenta triangles over the lower right of the picture, whatever OSG
/// thinks that the state is, and puts the state back.
inline void drawRaw(osg::RenderInfo& info)
{
    const auto& gl = *info.getState()->get<osg::GLExtensions>();
    const char* source = "void main() { gl_FragColor = vec4(0.9, 0.0, 0.8, 0.5); }";
    GLint before = 0;
    glGetIntegerv(GL_CURRENT_PROGRAM, &before);
    const GLuint shader = gl.glCreateShader(GL_FRAGMENT_SHADER), program = gl.glCreateProgram();
    gl.glShaderSource(shader, 1, &source, nullptr);
    gl.glCompileShader(shader);
    gl.glAttachShader(program, shader);
    gl.glLinkProgram(program);
    glPushAttrib(GL_ALL_ATTRIB_BITS);
    glMatrixMode(GL_PROJECTION);
    glPushMatrix();
    glLoadIdentity();
    glMatrixMode(GL_MODELVIEW);
    glPushMatrix();
    glLoadIdentity();
    gl.glUseProgram(program);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glEnable(GL_SCISSOR_TEST);
    glScissor(40, 10, 80, 60);
    glBegin(GL_TRIANGLES);
    glVertex2f(-0.3f, -0.9f);
    glVertex2f(0.9f, -0.9f);
    glVertex2f(0.6f, 0.5f);
    glEnd();
    gl.glUseProgram(GLuint(before));
    glPopMatrix();
    glMatrixMode(GL_PROJECTION);
    glPopMatrix();
    glMatrixMode(GL_MODELVIEW);
    glPopAttrib();
    gl.glDeleteShader(shader);
    gl.glDeleteProgram(program);
}

struct RawDrawCallback : osg::Camera::DrawCallback
{
    void operator()(osg::RenderInfo& info) const override { drawRaw(info); }
};

/// Has no bound, so that only its callers know where it draws.
class RawDrawable : public osg::Drawable
{
public:
    RawDrawable()
    {
        setUseDisplayList(false);
        setSupportsDisplayList(false);
        setCullingActive(false);
        getOrCreateStateSet()->setRenderBinDetails(10, "RenderBin");
    }
    osg::BoundingBox computeBoundingBox() const override { return {}; }
    void drawImplementation(osg::RenderInfo& info) const override { drawRaw(info); }
};

} // namespace application
