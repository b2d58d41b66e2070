/** Buttons to come nearer to a map and to see all of it again, and how long a metre is on it. */
import { Maximize, Minus, Plus } from "lucide-react";
import { useTranslation } from "react-i18next";
import { IconButton } from "@/design/IconButton";
import { Panel } from "@/design/Panel";
import { formatNumber, withUnit } from "@/i18n/format";
import classes from "./MapPage.module.css";
import { scaleBar } from "./scaleBar";
import { PIXELS_PER_METRE } from "@/map/plane/projection";
import type { ZoomedView } from "./useZoomedView";

const LONGEST_BAR = 88;

export function ZoomControls({ zoomed }: { zoomed: ZoomedView }) {
  const { t } = useTranslation();
  const { metres, pixels } = scaleBar(zoomed.view.zoom, PIXELS_PER_METRE, LONGEST_BAR);
  const digits = Math.max(0, -Math.floor(Math.log10(metres)));
  return (
    <Panel floating className={classes.zoom ?? ""}>
      <IconButton label={t("pages.map.zoom.out")} disabled={!zoomed.isNearer} onClick={zoomed.zoomOut}>
        <Minus size={16} />
      </IconButton>
      <IconButton label={t("pages.map.zoom.in")} onClick={zoomed.zoomIn}>
        <Plus size={16} />
      </IconButton>
      <IconButton label={t("pages.map.zoom.fit")} disabled={!zoomed.isNearer} onClick={zoomed.fit}>
        <Maximize size={16} />
      </IconButton>
      <span className={classes.scale ?? ""} aria-hidden="true">
        {withUnit(formatNumber(metres, digits), "m")}
        <span style={{ width: pixels }} />
      </span>
    </Panel>
  );
}
