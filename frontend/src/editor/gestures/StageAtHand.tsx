/** Lends the map's view to the commands that zoom, and tells them where the pointer is. */
import { useEffect } from "react";
import { useStage } from "@/program/canvas/stageContext";
import { lastPointer, useScreen } from "../state/screen";

export function StageAtHand() {
  const stage = useStage();
  useEffect(() => {
    useScreen.setState({ stage });
    return () => useScreen.setState({ stage: null });
  }, [stage]);
  useEffect(() => {
    lastPointer.at = null;
    const see = ({ target, clientX, clientY }: PointerEvent) => {
      if (target instanceof Element && target.closest("[data-map]")) lastPointer.at = { x: clientX, y: clientY };
    };
    window.addEventListener("pointermove", see, { passive: true });
    return () => window.removeEventListener("pointermove", see);
  }, []);
  return null;
}
