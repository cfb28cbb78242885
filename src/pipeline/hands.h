/* Hands in the frame loop: when they are looked for, what their events do, how they are drawn. */
#ifndef RLF_PIPELINE_HANDS_H
#define RLF_PIPELINE_HANDS_H

#include "relief/hands.h"
#include "relief/pipeline.h"

#define HAND_MARKS_EACH 96 /* a disc, finger tips, directions and a word */
#define HAND_WORD_SIZE 48

typedef struct hand_stage {
    rlf_hand_tracker *tracker; /* made when first wanted */
    bool is_on;
    rlf_vec3 up_world;    /* unit: as the room's floors and walls say, as sure as this; */
    double up_confidence; /* below RLF_UP_SURE it is the world's own, -y */
    int32_t frames_asked; /* for it */
    rlf_hands now;
    const rlf_hands *last;                    /* `now`; NULL = none yet, or off */
    rlf_grid_hand shapes[RLF_GRID_HANDS_MAX]; /* of those that are hands, for physics */
    int32_t shape_count;
    rlf_mark marks[RLF_HANDS_MAX * HAND_MARKS_EACH];
    int32_t mark_count;
    char words[RLF_HANDS_MAX][HAND_WORD_SIZE];
} hand_stage;

rlf_result hand_stage_set(hand_stage *stage, const rlf_camera *grid, bool is_on);
void hand_stage_destroy(hand_stage *stage);
/* All is forgotten, as after the first hand_stage_set. */
void hand_stage_restart(hand_stage *stage);
/* Finds the hands of a surface, if they are wanted. */
void hand_stage_update(hand_stage *stage, const rlf_surface *surface,
                       const rlf_pose *T_world_camera);
/* Gives the hands of the last update to physics. */
void hand_stage_show(hand_stage *stage, rlf_grid *grid);
/* Tells which hand holds which of the bodies that are grabbed: the nearest one. */
void hand_stage_hold(hand_stage *stage, const rlf_snapshot *snapshot,
                     const rlf_pose *T_world_camera);
/* True when a scene does something on an event of a hand. */
bool hand_scene_binds(const rlf_scene *scene);
/* Palm discs, finger tips and what is recognised, as marks. */
void hand_stage_draw(hand_stage *stage);

/* What an event is answered with, in the world. */
typedef struct hand_answer {
    const rlf_scene *scene;
    rlf_world *world;
    rlf_pose T_world_camera;
} hand_answer;

/* Does what the scene binds to the events of the last update. True: the bodies shall start anew. */
bool hand_stage_answer(const hand_stage *stage, const hand_answer *answer);

#endif
