/** What each part of the robots' picture is given. */
import type { Palette } from "../palette";
import type { Moment, SceneDevice, SceneRecording } from "../types";

export interface RobotsProps {
  robots: readonly SceneDevice[];
  recording: SceneRecording;
  moment: Moment;
  palette: Palette;
}
