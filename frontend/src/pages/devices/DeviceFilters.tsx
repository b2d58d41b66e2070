import { Select, TextInput } from "@mantine/core";
import { Search } from "lucide-react";
import { useTranslation } from "react-i18next";
import type { Device } from "@/api/types";
import { methodNames, type DeviceFilter } from "./filter";
import styles from "./devices.module.css";

const STATUSES = ["idle", "busy", "done", "waiting", "warning", "error", "offline", "pending"];

interface DeviceFiltersProps {
  devices: readonly Device[];
  filter: DeviceFilter;
  change: (filter: DeviceFilter) => void;
}

export function DeviceFilters({ devices, filter, change }: DeviceFiltersProps) {
  const { t } = useTranslation();
  const choices = {
    status: STATUSES.map((value) => ({ value, label: t(`shell.status.${value}`) })),
    kind: ["machine", "robot"].map((value) => ({ value, label: t(`pages.devices.kind.${value}`) })),
    method: methodNames(devices).map((value) => ({ value, label: value })),
  };
  return (
    <search className={styles.filters}>
      <TextInput
        className={styles.find}
        leftSection={<Search size={16} aria-hidden="true" />}
        aria-label={t("pages.devices.find")}
        placeholder={t("pages.devices.find")}
        value={filter.query}
        onChange={(event) => change({ ...filter, query: event.target.value })}
      />
      {(["status", "kind", "method"] as const).map((field) => (
        <Select
          key={field}
          clearable
          className={styles.choice}
          aria-label={t(`pages.devices.filter.${field}`)}
          placeholder={t(`pages.devices.filter.${field}`)}
          data={choices[field]}
          value={filter[field]}
          onChange={(value) => change({ ...filter, [field]: value })}
        />
      ))}
    </search>
  );
}
