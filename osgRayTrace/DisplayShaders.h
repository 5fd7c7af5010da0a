// DisplayShaders.h - the shaders that present a picture with its depth. Layer: public API, private.
// SPDX-License-Identifier: MIT
#pragma once

namespace osgRayTrace
{

// The shaders are GLSL 1.20, and 3.30 for contexts that take no older version: one text, two
// dialects.
constexpr const char* kVertexDialect = "#version 120\n"
                                       "#define IN attribute\n"
                                       "#define OUT varying\n";
constexpr const char* kFragmentDialect = "#version 120\n"
                                         "#define IN varying\n"
                                         "#define SAMPLE texture2D\n"
                                         "#define FRAGMENT gl_FragColor\n";
constexpr const char* kCoreVertexDialect = "#version 330 core\n"
                                           "#define IN in\n"
                                           "#define OUT out\n";
constexpr const char* kCoreFragmentDialect = "#version 330 core\n"
                                             "#define IN in\n"
                                             "#define SAMPLE texture\n"
                                             "out vec4 fragment;\n"
                                             "#define FRAGMENT fragment\n";

constexpr const char* kVertexShader = R"(
IN vec2 corner;
OUT vec2 position;
void main()
{
    position = 0.5 * corner + 0.5;
    gl_Position = vec4(corner, 0.0, 1.0);
}
)";

// glDepthRange does not map gl_FragDepth, so the shader does. Edges whose first sample missed have
// the depth of the background, but must pass the test against it: the shader draws them right in
// front of the background. A pass that shows a slice of the depths leaves the other depths to other
// passes.
constexpr const char* kFragmentShader = R"(
uniform sampler2D osgRayTrace_color;
uniform sampler2D osgRayTrace_depth;
uniform vec3 osgRayTrace_depthMap; // scale, offset, background
IN vec2 position;
void main()
{
    vec4 color = SAMPLE(osgRayTrace_color, position);
    if (color.a == 0.0) discard;
    float traced = SAMPLE(osgRayTrace_depth, position).r;
    float depth = traced < 1.0 ? osgRayTrace_depthMap.x * traced + osgRayTrace_depthMap.y
                               : osgRayTrace_depthMap.z;
    if (depth < 0.0 || depth > 1.0) discard;
    FRAGMENT = color;
    gl_FragDepth = gl_DepthRange.near + gl_DepthRange.diff * min(depth, 0.99999994);
}
)";

} // namespace osgRayTrace
