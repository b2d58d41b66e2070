/** Which layers of the map are shown, in its corner; folded it hides next to nothing. */
import { Switch } from "@mantine/core";
import { ChevronDown, ChevronUp, Flame, Layers3, type LucideIcon, MapPin, Ruler, SquareDashed } from "lucide-react";
import { useId } from "react";
import { useTranslation } from "react-i18next";
import { USE_DAYS } from "@/api/floorUse";
import { Panel } from "@/design/Panel";
import { formatNumber } from "@/i18n/format";
import { type Heat, mostDrives } from "./heatPainter";
import { problemText } from "@/shell/LoadProblem";
import { type Layer, LAYERS } from "./layers";
import styles from "./layers.module.css";
import type { Layers } from "./useLayers";

const ICONS: Readonly<Record<Layer, LucideIcon>> = { zones: SquareDashed, places: MapPin, check: Ruler, heat: Flame };

export function LayersCard({ layers }: { layers: Layers }) {
  const { t } = useTranslation();
  const body = useId();
  const { chosen, change, isOpen } = layers;
  const Chevron = isOpen ? ChevronDown : ChevronUp;
  return (
    <Panel floating className={styles.card} aria-label={t("layers.layers")}>
      <button
        type="button"
        className={styles.head}
        aria-expanded={isOpen}
        aria-controls={isOpen ? body : undefined}
        onClick={() => change({ open: !isOpen })}
      >
        <Layers3 size={16} aria-hidden="true" />
        {t("layers.layers")}
        <Chevron size={16} aria-hidden="true" />
      </button>
      {isOpen ? (
        <div id={body} className={styles.body}>
          {LAYERS.map((layer) => (
            <Choice
              key={layer}
              layer={layer}
              isShown={chosen[layer]}
              show={(isShown) => change({ [layer]: isShown })}
            />
          ))}
          {chosen.heat ? <HeatLegend layers={layers} /> : null}
        </div>
      ) : null}
    </Panel>
  );
}

interface ChoiceProps {
  layer: Layer;
  isShown: boolean;
  show: (isShown: boolean) => void;
}

function Choice({ layer, isShown, show }: ChoiceProps) {
  const { t } = useTranslation();
  const Icon = ICONS[layer];
  return (
    <Switch
      labelPosition="left"
      size="xs"
      classNames={{ body: styles.choice ?? "", label: styles.label ?? "" }}
      label={
        <>
          <Icon size={15} aria-hidden="true" />
          {t(`layers.layer.${layer}`, { days: USE_DAYS })}
        </>
      }
      checked={isShown}
      onChange={(event) => show(event.currentTarget.checked)}
    />
  );
}

/** What the colour says, or why there is none. */
function HeatLegend({ layers: { use, heat, error } }: { layers: Layers }) {
  const { t } = useTranslation();
  if (error)
    return (
      <p role="alert" className={styles.said}>
        {problemText(error, t("layers.failed"))}
      </p>
    );
  const why = use ? (use.runs === 0 ? "noRuns" : "noDrives") : "counting";
  return (
    <div role="status" className={styles.said}>
      {use && heat && heat.squares.length > 0 ? (
        <Scale heat={heat} runs={use.runs} isCut={use.is_cut} />
      ) : (
        t(`layers.${why}`, { days: USE_DAYS })
      )}
    </div>
  );
}

function Scale({ heat, runs, isCut }: { heat: Heat; runs: number; isCut: boolean }) {
  const { t } = useTranslation();
  const most = mostDrives(heat);
  return (
    <>
      <p className={styles.scale}>
        <span className={styles.colours} aria-hidden="true" />
        {t("layers.drives", { count: most, number: formatNumber(most) })}
      </p>
      <p>{t(isCut ? "layers.ofNewest" : "layers.of", { count: runs, number: formatNumber(runs) })}</p>
    </>
  );
}
