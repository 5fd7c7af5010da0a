// ModelCameraTest.cpp - osgraytrace takes the cameras that a model brings with it. Layer: tests.
// SPDX-License-Identifier: MIT
#include "Program.h"
#include "tests/Catch.h"

namespace
{

const std::string kQuick = " --passes 1 --size 60 40 --integrator whitted ";

/// A triangle, a perspective camera 10 in front of it and an orthographic one, with Y up.
const char* const kModel = R"({ "asset": { "version": "2.0" }, "scenes": [{ "nodes": [0, 1, 2] }],
    "buffers": [{ "byteLength": 36, "uri": "data:application/octet-stream;base64,
AAAAAAAAAAAAAAAAAAAAQAAAAAAAAAAAAAAAAAAAgEAAAAAA" }],
    "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
    "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" }],
    "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
    "cameras": [
        { "type": "perspective", "perspective": { "yfov": 0.5235988, "znear": 0.1 } },
        { "type": "orthographic",
          "orthographic": { "xmag": 3, "ymag": 3, "znear": 0.1, "zfar": 100 } }],
    "nodes": [{ "mesh": 0 }, { "name": "lens", "camera": 0, "translation": [1, 1, 10] },
              { "name": "plan", "camera": 1, "translation": [1, 1, 10] }] })";

void writeModel(const TemporaryFolder& folder)
{
    std::string model = kModel;
    model.erase(model.find('\n', model.find("base64,")), 1); // the text is longer than a line
    std::ofstream(folder / "model.gltf") << model;
}

} // namespace

TEST_CASE("osgraytrace --camera looks as the model's camera does", "[apps]")
{
    const TemporaryFolder folder;
    writeModel(folder);
    // Y up has become Z up: the camera is at (1, -10, 1).
    const Outcome own = osgraytrace(folder, "model.gltf -o own.exr --camera lens" + kQuick);
    INFO(own.errors);
    CHECK(own.exitCode == 0);
    CHECK(own.errors.empty()); // the cameras draw nothing, so nothing is left out
    CHECK(osgraytrace(folder, "model.gltf -o given.exr --eye 1 -10 1 --center 1 0 1 --up 0 0 1 "
                              "--fovy 30" +
                                  kQuick)
              .exitCode == 0);
    CHECK(osgraytrace(folder, "model.gltf -o home.exr" + kQuick).exitCode == 0);
    CHECK(osgraytrace(folder, "model.gltf -o plan.exr --camera plan" + kQuick).exitCode == 0);
    const auto difference = [&folder](const std::string& picture)
    {
        const Outcome outcome = osgraytrace(
            folder, "model.gltf -o x.exr --camera lens --reference " + picture + kQuick);
        INFO(outcome.output << outcome.errors);
        const std::size_t at = outcome.output.find("RMSE ");
        REQUIRE(at != std::string::npos);
        return std::stod(outcome.output.substr(at + 5));
    };
    CHECK(difference("own.exr") == 0.0);
    CHECK(difference("given.exr") < 0.02);
    CHECK(difference("home.exr") > 0.05);
    CHECK(difference("plan.exr") > 0.02);
}

TEST_CASE("osgraytrace --camera names the cameras that there are", "[apps]")
{
    const TemporaryFolder folder;
    writeModel(folder);
    const Outcome outcome = osgraytrace(folder, "model.gltf -o x.png --camera other" + kQuick);
    CHECK(outcome.exitCode == 1);
    CHECK(outcome.errors.find("lens, plan") != std::string::npos);
}
