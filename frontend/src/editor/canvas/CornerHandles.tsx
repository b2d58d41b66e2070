/** Corners on the map that can be changed, whose script comes with the first of them that is selected. */
import { lazy, Suspense } from "react";
import type { CornersProps } from "./Corners";

export const loadCorners = () => import("./Corners");
const Corners = lazy(async () => ({ default: (await loadCorners()).Corners }));

export function CornerHandles(props: CornersProps) {
  return (
    <Suspense fallback={null}>
      <Corners {...props} />
    </Suspense>
  );
}
