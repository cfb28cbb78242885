/* What a camera and a recording have in common: an open device and its pairs of pictures. */
#ifndef RLF_IO_OPENNI2_PLAYER_H
#define RLF_IO_OPENNI2_PLAYER_H

#include "io/openni2/device.h"
#include "io/source/stream_pair.h"

#include <stdatomic.h>

typedef struct openni2_player {
    char source[512]; /* as the user gave it, for error lines */
    char place[512];  /* of a file */
    openni2_wish wish;
    openni2_device device;
    rlf_rig rig;
    io_stream_pair pair;
    void *callbacks;
    atomic_bool is_gone;  /* the camera was unplugged or failed */
    atomic_bool is_ended; /* the recording is at its end */
    int64_t frame_count; /* of a recording */
} openni2_player;

/* Opens and starts. On failure nothing stays open. */
rlf_result openni2_player_create(const rlf_address *address, bool is_file, openni2_player **out);
/* `self` is an openni2_player. */
void openni2_player_destroy(void *self);
/* Closes the device, keeps the pictures. */
void openni2_player_close(openni2_player *player);
/* Opens the device again and starts its streams. */
rlf_result openni2_player_reopen(openni2_player *player);

/* Waits for a picture of either stream and stores it in the pair. RLF_NO_FRAME: none in time. */
rlf_result openni2_player_wait(openni2_player *player, int timeout_ms);

/* `self` is an openni2_player. */
void openni2_player_status(void *self, rlf_source_status *out);
/* The parts of a source that all players share. */
void openni2_player_describe(openni2_player *player, const rlf_source_methods *methods,
                             rlf_opened *out);

#endif
