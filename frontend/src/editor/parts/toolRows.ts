/** In how many rows the tools stand: one at the left or below, more where they would be wider than the screen. */
import { useMediaQuery } from "@mantine/hooks";

/** A row of the bar below: a target for fingers and the gap to the next. */
export const ROW_PX = 45;

/** Who may only look has two tools, for which every screen is wide enough. */
export function useToolRows(canEdit: boolean): 1 | 2 | 3 {
  const tens = useMediaQuery("(max-width: 1003px)") ?? false;
  const sevens = useMediaQuery("(max-width: 505px)") ?? false;
  if (!canEdit || !tens) return 1;
  return sevens ? 3 : 2;
}
