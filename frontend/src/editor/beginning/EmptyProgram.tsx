/** How to begin: what stands over the map of a program without steps, and leads on where a site lacks something. */
import { Button } from "@mantine/core";
import { Cpu, MapPinned } from "lucide-react";
import type { ReactNode } from "react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { DeviceIcon } from "@/map/devices/DeviceIcon";
import { isRobot } from "@/map/devices/device";
import { VipoIcon } from "@/design/VipoIcon";
import type { SiteDevice } from "@/program/surroundings";
import classes from "../canvas/float.module.css";
import { useOpenProgram } from "../state/context";
import { RESTING, takeTool, withDevice } from "../state/tool";
import { useUi } from "../state/ui";
import own from "./beginning.module.css";
import { useTour } from "./tourStops";

export function EmptyProgram() {
  const { document, canEdit, site, devices } = useOpenProgram();
  const resting = useUi((ui) => ui.gesture.tool === "select");
  const touring = useTour((tour) => tour.at !== null);
  if (!canEdit || !resting || touring || Object.keys(document.steps).length > 0) return null;
  if (!site.has_map) return <Lacking what="map" icon={<MapPinned size={22} aria-hidden="true" />} />;
  if (devices.length === 0) return <Lacking what="devices" icon={<Cpu size={22} aria-hidden="true" />} />;
  return <FirstTask />;
}

function Lacking({ what, icon }: { what: "map" | "devices"; icon: ReactNode }) {
  const { t } = useTranslation();
  const { site } = useOpenProgram();
  return (
    <section className={classes.empty} aria-label={t(`first.lacking.${what}.title`)}>
      <span className={classes.emptyIcon}>{icon}</span>
      <h2>{t(`first.lacking.${what}.title`)}</h2>
      <p>{t(`first.lacking.${what}.text`)}</p>
      <Button component={Link} to={`/sites/${site.slug}/${what}`}>
        {t(`first.lacking.${what}.action`)}
      </Button>
      <Links />
    </section>
  );
}

function FirstTask() {
  const { t } = useOpenProgram();
  const sources = useSources();
  return (
    <section className={classes.empty} aria-label={t("empty.title")}>
      <span className={classes.emptyIcon}>
        <VipoIcon name="pickdrop" size={22} />
      </span>
      <h2>{t("empty.title")}</h2>
      <p>{t("empty.text")}</p>
      <Sources sources={sources} />
      <Button
        variant={sources.length > 0 ? "default" : "filled"}
        onClick={() => useUi.setState({ gesture: takeTool(RESTING, "pick_and_drop", false) })}
      >
        {t("empty.action")}
      </Button>
      <Links />
    </section>
  );
}

const MOST_SOURCES = 3;

/** Machines that give something, first those that only do that: where things come in. */
function useSources(): readonly SiteDevice[] {
  const { devices } = useOpenProgram();
  const giving = devices.filter((each) => !isRobot(each) && each.lifecycle !== "pending" && each.gives.length > 0);
  return [...giving.filter((each) => each.takes.length === 0), ...giving.filter((each) => each.takes.length > 0)].slice(
    0,
    MOST_SOURCES,
  );
}

/** One press is the tool and the source. */
function Sources({ sources }: { sources: readonly SiteDevice[] }) {
  const { t } = useTranslation();
  if (sources.length === 0) return null;
  const from = (device: string) =>
    useUi.setState({ gesture: withDevice(takeTool(RESTING, "pick_and_drop", false), device) });
  return (
    <div className={own.sources} role="group" aria-label={t("first.sources")}>
      <span>{t("first.sources")}</span>
      {sources.map((device) => (
        <button key={device.id} type="button" className={own.choice} onClick={() => from(device.id)}>
          <DeviceIcon deviceClass={device.device_class} size={16} />
          {device.name}
        </button>
      ))}
    </div>
  );
}

function Links() {
  const { t } = useTranslation();
  const { devices } = useOpenProgram();
  return (
    <div className={own.links}>
      {devices.length > 0 ? (
        <button type="button" className={classes.link} onClick={() => useUi.setState({ dialog: "templates" })}>
          {t("first.templates.open")}
        </button>
      ) : null}
      <button type="button" className={classes.link} onClick={() => useUi.setState({ dialog: "library" })}>
        {t("editor.empty.import")}
      </button>
      <button type="button" className={classes.link} onClick={() => useTour.setState({ at: 0 })}>
        {t("first.tour.open")}
      </button>
    </div>
  );
}
