/** Where a run takes place: its program on the map, or the place in 3D. Which of both stands in the address. */
import { Box, Map as MapIcon, type LucideIcon } from "lucide-react";
import { lazy, type ReactNode, Suspense } from "react";
import { useTranslation } from "react-i18next";
import { useSearchParams } from "react-router-dom";
import type { Device, SiteMap } from "@/api/types";
import { Segments } from "@/design/Segments";
import styles from "./scene.module.css";

const LiveScene = lazy(() => import("./LiveScene").then((module) => ({ default: module.LiveScene })));

const VIEWS: readonly { view: "map" | "3d"; icon: LucideIcon }[] = [
  { view: "map", icon: MapIcon },
  { view: "3d", icon: Box },
];

interface RunPlaceProps {
  map: SiteMap | null;
  devices: readonly Device[];
  /** The program on the map. */
  children: ReactNode;
}

export function RunPlace({ map, devices, children }: RunPlaceProps) {
  const { t } = useTranslation();
  const [query, setQuery] = useSearchParams();
  const shown = query.get("view") === "3d" ? "3d" : "map";
  const show = (view: "map" | "3d") =>
    setQuery(
      (before) => {
        const after = new URLSearchParams(before);
        if (view === "3d") after.set("view", view);
        else after.delete("view");
        return after;
      },
      { replace: true },
    );
  return (
    <>
      {shown === "map" ? (
        children
      ) : (
        <Suspense fallback={null}>
          <LiveScene map={map} devices={devices} />
        </Suspense>
      )}
      <div className={styles.switch}>
        <Segments
          label={t("run.scene.label")}
          segments={VIEWS.map(({ view, icon }) => ({
            value: view,
            words: t(`run.scene.${view === "3d" ? "spatial" : "map"}`),
            icon,
          }))}
          value={shown}
          choose={show}
        />
      </div>
    </>
  );
}
