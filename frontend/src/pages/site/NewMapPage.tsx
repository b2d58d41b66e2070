/** A map for a site that is there: its first, or another one, which can be aligned with the present one. */
import { Button, Loader, Switch } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { MapPinned } from "lucide-react";
import { useMemo, useState, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import { Link, useNavigate, useParams } from "react-router-dom";
import { useBroughtMap } from "@/api/broughtMaps";
import { missing } from "@/api/failed";
import { useSite, useSiteMap } from "@/api/queries";
import { useBringMap } from "@/api/siteMaps";
import type { Site, SiteMap } from "@/api/types";
import { EmptyState } from "@/design/EmptyState";
import { Panel } from "@/design/Panel";
import { rosForm, type CellMap } from "@/map/floor/rosFiles";
import { LoadProblem, problemText } from "@/shell/LoadProblem";
import { PageShell } from "@/shell/PageShell";
import { MappingRobots, useMappingRobots } from "../map/MappingRobots";
import { SaveDialog } from "../mapEdit/SaveDialog";
import { AlignPanel } from "./align/AlignPanel";
import { useAlignment } from "./align/useAlignment";
import { kindOf } from "./files";
import { MapChoiceFields, MapChoicePreview } from "./MapChoiceParts";
import styles from "./newsite.module.css";
import { filesForm, useMapChoice, type MapChoice } from "./useMapChoice";

function FirstMap({ site }: { site: Site }) {
  const { t } = useTranslation();
  const choice = useMapChoice(site.slug);
  const bring = useBringMap(site.slug);
  const navigate = useNavigate();
  const submit = (event: FormEvent) => {
    event.preventDefault();
    const sent = bring.mutateAsync({ form: choice.makeForm(), source: choice.source, replaces: null });
    // The page may be loading the new map by then, so this does not hang on what is shown.
    sent.then(
      ({ version }) => {
        notifications.show({ message: t("mapEdit.saved", { version }) });
        return navigate(`/sites/${site.slug}/map`);
      },
      () => undefined, // the form shows why
    );
  };
  const choose = (chosen: readonly File[]) => {
    choice.choose(chosen);
    bring.reset();
  };
  const problem = bring.isError ? problemText(bring.error, t("shell.problem.screen")) : null;
  return (
    <div className={styles.page}>
      <div className={styles.choices}>
        <Panel className={styles.card}>
          <form onSubmit={submit} className={styles.form}>
            <div>
              <h2>{t("mapEdit.first", { site: site.name })}</h2>
              <p>{t("pages.newSite.text")}</p>
            </div>
            <MapChoiceFields choice={choice} problem={problem} choose={choose} />
            <Button type="submit" size="md" disabled={!choice.isReady} loading={bring.isPending}>
              {t("mapEdit.use")}
            </Button>
          </form>
        </Panel>
        <ByRobot slug={site.slug} />
      </div>
      <MapChoicePreview choice={choice} />
    </div>
  );
}

/** The other way to a first map, where a robot is at hand that can make one. */
function ByRobot({ slug }: { slug: string }) {
  const { t } = useTranslation();
  if (useMappingRobots(slug).length === 0) return null;
  return (
    <Panel className={styles.card}>
      <div className={styles.form}>
        <div>
          <h2>{t("mapEdit.byRobot")}</h2>
          <p>{t("mapEdit.byRobotText")}</p>
        </div>
        <MappingRobots slug={slug} waiting />
      </div>
    </Panel>
  );
}

/** The chosen map as cells, for laying it on another: the browser's own, or a ROS map as the server reads it. */
function useCells(site: string, choice: MapChoice, isWanted: boolean) {
  const { files, picture, reading, drawn } = choice;
  const isRos = kindOf(files) === "map";
  const ask = isWanted && isRos ? () => filesForm(files) : null;
  const brought = useBroughtMap(site, [files.yaml, files.image, files.archive], ask);
  const { makeMap } = choice;
  // oxlint-disable-next-line react/exhaustive-deps -- it is made anew only where what it is made of is another
  const own = useMemo((): CellMap | null => (isWanted ? makeMap() : null), [isWanted, picture, reading, drawn?.map]);
  const cells = isRos ? (brought.data ?? null) : own;
  return { cells, error: isRos ? brought.error : null, isReading: isRos && brought.isFetching };
}

function AnotherMap({ site, present }: { site: Site; present: SiteMap }) {
  const { t } = useTranslation();
  const choice = useMapChoice(site.slug);
  const navigate = useNavigate();
  const [isAligned, align] = useState(false);
  const [base, setBase] = useState<SiteMap | null>(null);
  const { cells, error, isReading } = useCells(site.slug, choice, isAligned && choice.isReady);
  const alignment = useAlignment(cells, present, kindOf(choice.files) === "map");
  const map = isAligned ? alignment.map : null;
  const submit = (event: FormEvent) => {
    event.preventDefault();
    setBase(present);
  };
  return (
    <div className={styles.page}>
      <Panel className={styles.card}>
        <form onSubmit={submit} className={styles.form}>
          <div>
            <h2>{t("mapEdit.another", { site: site.name })}</h2>
            <p>{t("pages.newSite.text")}</p>
          </div>
          <MapChoiceFields
            choice={choice}
            problem={error ? problemText(error, t("shell.problem.screen")) : null}
            choose={choice.choose}
          />
          <Switch
            label={t("mapImport.align.switch")}
            description={t("mapImport.align.switchText")}
            checked={isAligned}
            disabled={!choice.isReady}
            onChange={(event) => align(event.currentTarget.checked)}
          />
          <Button type="submit" size="md" disabled={!choice.isReady || (isAligned && !map)}>
            {t("mapEdit.use")}
          </Button>
        </form>
      </Panel>
      {isAligned && cells ? (
        <Panel className={styles.align}>
          <AlignPanel brought={cells} present={present} alignment={alignment} />
        </Panel>
      ) : isReading ? (
        <Panel className={styles.side}>
          <p role="status">
            <Loader size={14} aria-hidden="true" /> {t("mapImport.readingMap")}
          </p>
        </Panel>
      ) : (
        <MapChoicePreview choice={choice} />
      )}
      {base === null ? null : (
        <SaveDialog
          slug={site.slug}
          title={t("mapImport.ask")}
          action={t("mapEdit.use")}
          makeForm={() => (map ? rosForm(map) : choice.makeForm())}
          source={choice.source}
          base={base}
          newest={present}
          onSaved={() => void navigate(`/sites/${site.slug}/map`)}
          onClose={() => setBase(null)}
        />
      )}
    </div>
  );
}

export function NewMapPage() {
  const { t } = useTranslation();
  const { slug = "" } = useParams();
  const site = useSite(slug);
  const map = useSiteMap(site.data?.has_map ? slug : undefined);
  const problem = missing(site, map);
  const isAdmin = site.data?.role === "admin";
  return (
    <PageShell title={t("mapEdit.upload")}>
      {problem ? <LoadProblem error={problem} again={() => void Promise.all([site.refetch(), map.refetch()])} /> : null}
      {site.data && isAdmin && !site.data.has_map ? <FirstMap site={site.data} /> : null}
      {site.data && isAdmin && map.data ? <AnotherMap site={site.data} present={map.data} /> : null}
      {site.data && !isAdmin ? (
        <Panel>
          <EmptyState icon={<MapPinned size={20} />} title={t("mapEdit.adminsOnly")} text={t("mapEdit.askAdmin")}>
            <Button component={Link} to={`/sites/${slug}/map`} variant="default">
              {t("shell.nav.map")}
            </Button>
          </EmptyState>
        </Panel>
      ) : null}
    </PageShell>
  );
}
