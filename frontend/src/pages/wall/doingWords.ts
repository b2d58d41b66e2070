import { activityWords } from "@/i18n/activity";
import type { WallDevice } from "./wall";

/** What a device does, as a wall may say it; of what is simulated in place of a real one it says so. */
export function doingWords({ activity, stand_in = false }: Pick<WallDevice, "activity" | "stand_in">): string {
  return activityWords({ doing: "", activity, stand_in });
}
