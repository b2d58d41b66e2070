/** All German texts, loaded where the screens are German. */
import { gatherAreas } from "./areas";

export const texts = gatherAreas(
  import.meta.glob<Record<string, unknown>>("./de/*.json", { eager: true, import: "default" }),
);
