/** The tools at the left of the map, and how near it is seen. */
import { Maximize, Minus, Plus } from "lucide-react";
import { useTranslation } from "react-i18next";
import { IconButton } from "@/design/IconButton";
import styles from "./mapEdit.module.css";
import { TOOLS, type ToolName } from "./tools";
import type { MapView } from "./useMapView";

interface RailProps {
  tool: ToolName;
  choose: (tool: ToolName) => void;
  view: MapView;
}

export function ToolRail({ tool, choose, view }: RailProps) {
  const { t } = useTranslation();
  return (
    <>
      <div className={styles.rail} role="toolbar" aria-orientation="vertical" aria-label={t("mapEdit.tools")}>
        {TOOLS.map(({ name, key, icon: Icon }) => (
          <button
            key={name}
            type="button"
            aria-pressed={tool === name}
            aria-keyshortcuts={key.toUpperCase()}
            aria-label={t(`mapEdit.tool.${name}`)}
            title={t(`mapEdit.tool.${name}`)}
            onClick={() => choose(name)}
          >
            <Icon size={17} aria-hidden="true" />
            <kbd>{key.toUpperCase()}</kbd>
          </button>
        ))}
      </div>
      <div className={styles.zoom}>
        <IconButton label={t("mapEdit.zoomOut")} onClick={() => view.zoomAt(0.8)}>
          <Minus size={16} aria-hidden="true" />
        </IconButton>
        <IconButton label={t("mapEdit.zoomIn")} onClick={() => view.zoomAt(1.25)}>
          <Plus size={16} aria-hidden="true" />
        </IconButton>
        <IconButton label={t("mapEdit.zoomFit")} onClick={view.fit}>
          <Maximize size={16} aria-hidden="true" />
        </IconButton>
      </div>
    </>
  );
}
