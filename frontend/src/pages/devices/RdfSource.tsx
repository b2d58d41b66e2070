import { SegmentedControl, Skeleton } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import { LoadProblem } from "@/app/LoadProblem";
import { Panel } from "@/design/Panel";
import { SourceView } from "./SourceView";
import styles from "./detail.module.css";

const FORMATS = [
  { value: "turtle", label: "Turtle" },
  { value: "json-ld", label: "JSON-LD" },
];

/** Where a device's description can be read as RDF. */
export function rdfPath(slug: string, device: string, format: string): string {
  return `/sites/${slug}/devices/${encodeURIComponent(device)}/rdf?format=${format}`;
}

/** JSON is spread over lines; Turtle stays as it is. */
function laidOut(text: string, format: string): string {
  return format === "json-ld" ? JSON.stringify(JSON.parse(text), null, 2) : text;
}

export function RdfSource({ slug, device }: { slug: string; device: string }) {
  const { t } = useTranslation();
  const [format, setFormat] = useState("turtle");
  const rdf = useQuery({
    queryKey: keys.rdf(slug, device, format),
    queryFn: async () => laidOut(await api.text(rdfPath(slug, device, format)), format),
  });
  return (
    <Panel className={styles.rdf}>
      <div className={styles.cardHead}>
        <h3>{t("pages.devices.rdf")}</h3>
        <SegmentedControl
          size="xs"
          data={FORMATS}
          value={format}
          onChange={setFormat}
          aria-label={t("pages.devices.rdfForm")}
        />
      </div>
      {rdf.isPending ? <Skeleton height={240} /> : null}
      {rdf.isError ? <LoadProblem error={rdf.error} again={() => void rdf.refetch()} /> : null}
      {rdf.data ? (
        <SourceView text={rdf.data} dialect={format === "turtle" ? "turtle" : "json"} label={t("pages.devices.rdf")} />
      ) : null}
    </Panel>
  );
}
