/* A small recording as k4arecorder writes it: Matroska with raw depth, infrared and JPEG colour,
 * the calibration attached. Include after cmocka.h. */
#ifndef RLF_TEST_MKV_SAMPLE_H
#define RLF_TEST_MKV_SAMPLE_H

#include "byte_file.h"
#include "jpeg_sample.h"

#include <stdbool.h>
#include <stdlib.h>

#define MKV_SAMPLE_FRAMES 3

static inline void mkv_id(byte_file *b, uint32_t id)
{
    for (int shift = 24; shift >= 0; shift -= 8) {
        if (id >> shift != 0) {
            bytes_u8(b, (uint8_t)(id >> shift));
        }
    }
}

static inline void mkv_put(byte_file *b, uint32_t id, const void *data, size_t size)
{
    mkv_id(b, id);
    bytes_u8(b, 0x01);
    for (int shift = 48; shift >= 0; shift -= 8) {
        bytes_u8(b, (uint8_t)((uint64_t)size >> shift));
    }
    bytes_put(b, data, size);
}

static inline void mkv_number(byte_file *b, uint32_t id, uint32_t value)
{
    const uint8_t data[4] = {(uint8_t)(value >> 24), (uint8_t)(value >> 16), (uint8_t)(value >> 8),
                             (uint8_t)value};
    mkv_put(b, id, data, 4);
}

static inline void mkv_text(byte_file *b, uint32_t id, const char *text)
{
    mkv_put(b, id, text, strlen(text));
}

/* An element of a size that is not known: what a recorder that dies leaves. */
static inline void mkv_open(byte_file *b, uint32_t id)
{
    mkv_id(b, id);
    const uint8_t unknown[8] = {0x01, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
    bytes_put(b, unknown, sizeof(unknown));
}

static inline void mkv_track_put(byte_file *b, uint32_t number, const char *name,
                                 const char *fourcc, const uint32_t size[2])
{
    mkv_open(b, 0xAE);
    mkv_number(b, 0xD7, number);
    mkv_text(b, 0x536E, name);
    mkv_text(b, 0x86, strcmp(fourcc, "MJPG") == 0 ? "V_MJPEG" : "V_MS/VFW/FOURCC");
    uint8_t header[40] = {40};
    memcpy(header + 16, fourcc, 4);
    mkv_put(b, 0x63A2, header, sizeof(header));
    mkv_open(b, 0xE0);
    mkv_number(b, 0xB0, size[0]);
    mkv_number(b, 0xBA, size[1]);
}

static inline void mkv_tag_put(byte_file *b, const char *name, const char *value)
{
    mkv_open(b, 0x7373);
    mkv_open(b, 0x67C8);
    mkv_text(b, 0x45A3, name);
    mkv_text(b, 0x4487, value);
}

/* Big-endian counts: pixel p of frame i holds 1000 + 100 i + p % 64. */
static inline void mkv_depth_put(byte_file *b, uint32_t track, int i, size_t pixels)
{
    uint8_t *block = calloc(1, 4 + 2 * pixels);
    block[0] = (uint8_t)(0x80 | track);
    for (size_t p = 0; p < pixels; p++) {
        const size_t value = 1000 + 100 * (size_t)i + p % 64;
        block[4 + 2 * p] = (uint8_t)(value >> 8);
        block[5 + 2 * p] = (uint8_t)value;
    }
    mkv_put(b, 0xA3, block, 4 + 2 * pixels);
    free(block);
}

/* The calibration as the device holds it: normalised to the whole sensors. */
static const char mkv_calibration[] =
    "{\"CalibrationInformation\":{\"Cameras\":["
    "{\"Intrinsics\":{\"ModelParameterCount\":14,\"ModelParameters\":[0.5,0.5,0.4921875,0.4921875,"
    "0.5,-0.02,-0.003,0.9,0.09,-0.01,0,0,-7e-05,2e-05],"
    "\"ModelType\":\"CALIBRATION_LensDistortionModelBrownConrady\"},"
    "\"Location\":\"CALIBRATION_CameraLocationD0\",\"Purpose\":\"CALIBRATION_CameraPurposeDepth\","
    "\"MetricRadius\":1.74,\"Rt\":{\"Rotation\":[1,0,0,0,1,0,0,0,1],\"Translation\":[0,0,0]},"
    "\"SensorHeight\":1024,\"SensorWidth\":1024},"
    "{\"Intrinsics\":{\"ModelParameterCount\":14,\"ModelParameters\":[0.5,0.5,0.478,0.637,"
    "0.3,-2.5,1.4,0.2,-2.3,1.3,0,0,-1e-04,-2e-04],"
    "\"ModelType\":\"CALIBRATION_LensDistortionModelBrownConrady\"},"
    "\"Location\":\"CALIBRATION_CameraLocationPV0\","
    "\"Purpose\":\"CALIBRATION_CameraPurposePhotoVideo\",\"MetricRadius\":0,"
    "\"Rt\":{\"Rotation\":[1,0,0,0,0.9962,0.0871,0,-0.0871,0.9962],"
    "\"Translation\":[-0.032,-0.002,0.004]},\"SensorHeight\":3072,\"SensorWidth\":4096}]}}";

/* Frame i: depth and infrared at i x 32 ms, colour 2 ms later. `size` is that of depth. */
static inline byte_file *mkv_sample_make(const uint32_t size[2], bool has_calibration)
{
    static const uint32_t color_size[2] = {16, 8};
    byte_file *b = calloc(1, sizeof(*b));
    mkv_put(b, 0x1A45DFA3, "", 0);
    mkv_open(b, 0x18538067);
    mkv_open(b, 0x1549A966);
    mkv_number(b, 0x2AD7B1, 1000); /* microseconds, as k4arecorder has it */
    mkv_open(b, 0x1654AE6B);
    mkv_track_put(b, 1, "COLOR", "MJPG", color_size);
    mkv_track_put(b, 2, "IR", "b16g", size);
    mkv_track_put(b, 3, "DEPTH", "b16g", size);
    if (has_calibration) {
        mkv_open(b, 0x1941A469);
        mkv_open(b, 0x61A7);
        mkv_text(b, 0x466E, "calibration.json");
        mkv_text(b, 0x465C, mkv_calibration);
    }
    mkv_open(b, 0x1254C367);
    mkv_tag_put(b, "K4A_DEPTH_MODE", "NFOV_2X2BINNED");
    mkv_tag_put(b, "K4A_DEVICE_SERIAL_NUMBER", "000123");
    mkv_tag_put(b, "K4A_START_OFFSET_NS", "5000000");
    for (int i = 0; i < MKV_SAMPLE_FRAMES; i++) {
        mkv_open(b, 0x1F43B675);
        mkv_number(b, 0xE7, 32000 * (uint32_t)i);
        const size_t pixels = (size_t)size[0] * size[1];
        mkv_depth_put(b, 2, 7, pixels < 16 ? pixels : 16);
        mkv_depth_put(b, 3, i, pixels);
        uint8_t block[4 + sizeof(jpeg_sample)] = {0x81, 2000 >> 8, 2000 & 0xFF, 0};
        memcpy(block + 4, jpeg_sample, sizeof(jpeg_sample));
        mkv_put(b, 0xA3, block, sizeof(block));
    }
    return b;
}

#endif
