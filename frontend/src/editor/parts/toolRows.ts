/** In how many rows the tools stand: one at the left or below, two where they would be wider; on a phone one scrolls. */
import { useMediaQuery } from "@mantine/hooks";

/** A row of the bar below: a target for fingers and the gap to the next. */
export const ROW_PX = 45;

/** Who may only look has two tools, for which every screen is wide enough. */
export function useToolRows(canEdit: boolean): 1 | 2 {
  const tens = useMediaQuery("(506px <= width <= 1003px)") ?? false;
  return canEdit && tens ? 2 : 1;
}
