/** The English texts of the screens beside the editor, which does not wait for them. */
import { gatherAreas } from "./areas";

export const texts = gatherAreas(
  import.meta.glob<Record<string, unknown>>("./en/screens/*.json", { eager: true, import: "default" }),
);
