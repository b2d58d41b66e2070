/** All English texts, loaded where the screens are English. */
import { gatherAreas } from "./areas";

export const texts = gatherAreas(
  import.meta.glob<Record<string, unknown>>("./en/*.json", { eager: true, import: "default" }),
);
