/** A map for a site that is there: its first, or another one. */
import { Button } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { MapPinned } from "lucide-react";
import type { FormEvent } from "react";
import { useTranslation } from "react-i18next";
import { Link, useNavigate, useParams } from "react-router-dom";
import { missing } from "@/api/failed";
import { useSite, useSiteMap } from "@/api/queries";
import { useBringMap } from "@/api/siteMaps";
import type { Site } from "@/api/types";
import { EmptyState } from "@/design/EmptyState";
import { Panel } from "@/design/Panel";
import { LoadProblem, problemText } from "@/shell/LoadProblem";
import { PageShell } from "@/shell/PageShell";
import { MapChoiceFields, MapChoicePreview } from "./MapChoiceParts";
import styles from "./newsite.module.css";
import { useMapChoice } from "./useMapChoice";

function NewMap({ site, replaces }: { site: Site; replaces: number }) {
  const { t } = useTranslation();
  const navigate = useNavigate();
  const choice = useMapChoice();
  const bring = useBringMap(site.slug);
  const submit = (event: FormEvent) => {
    event.preventDefault();
    const sent = bring.mutateAsync({ form: choice.makeForm(), source: choice.source, replaces });
    // The page may be loading the new map by then, so this does not hang on what is shown.
    sent.then(
      ({ version }) => {
        notifications.show({ message: t("mapEdit.saved", { version }) });
        void navigate(`/sites/${site.slug}/map`);
      },
      () => undefined, // the form shows why
    );
  };
  const problem = bring.isError ? problemText(bring.error, t("shell.problem.screen")) : null;
  const choose = (chosen: readonly File[]) => {
    choice.choose(chosen);
    bring.reset();
  };
  return (
    <div className={styles.page}>
      <Panel className={styles.card}>
        <form onSubmit={submit} className={styles.form}>
          <div>
            <h2>{t(replaces ? "mapEdit.another" : "mapEdit.first", { site: site.name })}</h2>
            <p>{t("pages.newSite.text")}</p>
          </div>
          <MapChoiceFields choice={choice} problem={problem} choose={choose} />
          <Button type="submit" size="md" disabled={!choice.isReady} loading={bring.isPending}>
            {t("mapEdit.use")}
          </Button>
        </form>
      </Panel>
      <MapChoicePreview choice={choice} />
    </div>
  );
}

export function NewMapPage() {
  const { t } = useTranslation();
  const { slug = "" } = useParams();
  const site = useSite(slug);
  const map = useSiteMap(site.data?.has_map ? slug : undefined);
  const problem = missing(site, map);
  const isKnown = site.data && (!site.data.has_map || map.data);
  return (
    <PageShell title={t("mapEdit.upload")}>
      {problem ? <LoadProblem error={problem} again={() => void Promise.all([site.refetch(), map.refetch()])} /> : null}
      {site.data && isKnown && site.data.role === "admin" ? (
        <NewMap site={site.data} replaces={map.data?.version ?? 0} />
      ) : null}
      {site.data && site.data.role !== "admin" ? (
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
