// DIR/preview.mp4 and DIR/preview.gif from the PNGs, by the program ffmpeg.
#pragma once

#include "cli/console.h"
#include "cli/folder.h"

typedef enum VideoResult {
    VIDEO_MADE,
    VIDEO_NO_PROGRAM, ///< there is no ffmpeg
    VIDEO_FAILED,     ///< ffmpeg exists, but left no video
} VideoResult;

/// Makes the video of the frames from `first` up to `last`. If there is no ffmpeg (a warning) or it fails (an error),
/// the message says why, and the command that makes the video later.
VideoResult video_make(Console *console, const Folder *folder, double fps, int first, int last);

/// DIR/preview.gif, at most 640 pixels wide and 25 frames a second, in the same way.
VideoResult gif_make(Console *console, const Folder *folder, double fps, int first, int last);
