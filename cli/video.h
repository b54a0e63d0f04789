// DIR/preview.mp4 from the PNGs, by the program ffmpeg.
#ifndef CLI_VIDEO_H
#define CLI_VIDEO_H

#include "cli/console.h"
#include "cli/folder.h"

/// Makes the video of the frames from `first` up to `last`. Without ffmpeg, or when it fails, a warning tells the
/// command that makes it later. True when the video is there.
bool video_make(Console *console, const Folder *folder, double fps, int first, int last);

#endif
